"""Four corners of a convex outline."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True)
def _farthest(points: NDArray[np.float64], x: float, y: float) -> int:
    best, at = -1.0, 0
    for k in range(points.shape[0]):
        gap = (points[k, 0] - x) ** 2 + (points[k, 1] - y) ** 2
        if gap > best:
            best, at = gap, k
    return at


@njit(cache=True, nogil=True)
def _diameter(points: NDArray[np.float64]) -> tuple[int, int]:
    best, first, second = -1.0, 0, 0
    for i in range(points.shape[0]):
        for k in range(i):
            gap = (points[k, 0] - points[i, 0]) ** 2 + (points[k, 1] - points[i, 1]) ** 2
            if gap > best:
                best, first, second = gap, i, k
    return first, second


@njit(cache=True, nogil=True)
def quadrilateral(points: NDArray[np.float64], corners: NDArray[np.float64]) -> bool:
    """Corners (4, 2) of points (n, 2) about a quadrilateral: top left, then clockwise as seen.

    The two points furthest apart, and on either side of them the one furthest from their line.
    False where that is no quadrilateral.
    """
    first, second = _diameter(points)
    dx, dy = points[second, 0] - points[first, 0], points[second, 1] - points[first, 1]
    length = math.hypot(dx, dy)
    if not length > 0.0:
        return False
    low, high, below, above = 0.0, 0.0, first, first
    for k in range(points.shape[0]):
        side = dx * (points[k, 1] - points[first, 1]) - dy * (points[k, 0] - points[first, 0])
        if side < low:
            low, below = side, k
        if side > high:
            high, above = side, k
    # a triangle has nothing to speak of on one side
    if min(-low, high) < 0.1 * max(-low, high) or max(-low, high) < 0.02 * length**2:
        return False
    around = np.array([first, below, second, above])
    top, best = 0, np.inf
    for k in range(4):
        height = points[around[k], 1] + points[around[(k + 1) % 4], 1]
        if height < best:
            best, top = height, k
    for k in range(4):
        corners[k] = points[around[(top + k) % 4]]
    return True
