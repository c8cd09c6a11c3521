"""Fields to minimise: like pictures, like noise, and made to be hard."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

STATISTICS = ("noise", "signs", "smooth", "object", "halves", "slope", "rare", "squares", "path")


def random_field(statistics: str, shape: tuple[int, int], seed: int) -> NDArray[np.int32]:
    """Differences (h, w) int32; worth minimising with beta from 0 to some thousands."""
    rng = np.random.default_rng(seed)
    rows, columns = np.indices(shape)
    if statistics == "noise":
        field = rng.integers(-300, 300, shape)
    elif statistics == "signs":
        field = np.where(rng.random(shape) < 0.5, -100, 100)
    elif statistics == "smooth":
        field = cv2.GaussianBlur(rng.normal(0.0, 5000.0, shape), (0, 0), 5)
    elif statistics == "object":
        inside = np.hypot(rows - shape[0] / 2, columns - shape[1] / 2) < min(shape) / 4
        field = np.where(inside, -700, 1500) + rng.normal(0.0, 900.0, shape)
    elif statistics == "halves":
        field = np.where(columns < shape[1] // 2, 100, -100)
    elif statistics == "slope":
        field = np.linspace(-200.0, 200.0, shape[1]) + rng.integers(-1, 2, shape)
    elif statistics == "rare":
        field = np.where(rng.random(shape) < 0.02, -5000, 100)
    elif statistics == "squares":
        field = np.where((rows + columns) % 2 == 1, -100, 101)
    else:
        # one way that winds back and forth between walls, excess all along, need at its end
        wall = (rows % 2 == 1) & (columns != np.where(rows % 4 == 1, shape[1] - 1, 0))
        field = np.where(wall, 3000, 1)
        field[0, 0] = -30 * field.size
    return np.ascontiguousarray(field, dtype=np.int32)
