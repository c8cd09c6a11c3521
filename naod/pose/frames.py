"""Rotations from directions."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray


def facing(axis: NDArray[np.float64], centre: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation (3, 3) whose y is along `axis` and whose z looks towards the camera."""
    y = axis / math.sqrt(axis @ axis)
    z = -centre + (centre @ y) * y
    length = math.sqrt(z @ z)
    if length < 1e-9 * math.sqrt(centre @ centre):
        # seen exactly along its axis: any z will do
        other = (1.0, 0.0, 0.0) if abs(y[0]) < 0.9 else (0.0, 1.0, 0.0)
        z = cross(y, np.array(other))
        length = math.sqrt(z @ z)
    z = z / length
    return np.column_stack([cross(y, z), y, z])


def cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Vector product of two (3,); numpy's takes ten times as long over so few numbers."""
    (a0, a1, a2), (b0, b1, b2) = a, b
    return np.array([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])
