"""Walls of rooms that are rendered: patches of many colours as a picture."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np

SIDE_PIXELS = 512
PATCHES = 150


def paint_wall(path: Path, seed: int) -> None:
    """Write a picture of patches of many colours and sizes, equal for equal seeds."""
    rng = np.random.default_rng([seed, 77])
    image = np.full((SIDE_PIXELS, SIDE_PIXELS, 3), rng.uniform(90, 200, 3), dtype=np.uint8)
    for _ in range(PATCHES):
        centre = tuple(int(c) for c in rng.integers(0, SIDE_PIXELS, 2))
        axes = tuple(int(a) for a in rng.integers(6, 60, 2))
        grey = rng.uniform(20.0, 235.0)
        colour = np.clip(grey + rng.normal(0.0, 35.0, 3), 0, 255).tolist()
        cv2.ellipse(image, centre, axes, float(rng.uniform(0, 180)), 0, 360, colour, -1)
    cv2.imwrite(str(path), image)
