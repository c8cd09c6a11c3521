"""The smallest rectangle around a convex hull (Freeman and Shapira 1975)."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

_SLACK = 1e-9


@njit(cache=True, nogil=True)
def _extent_along(hull: NDArray[np.int32], count: int, ux: float, uy: float) -> tuple[float, float]:
    low, high = math.inf, -math.inf
    for k in range(count):
        at = hull[k, 0] * ux + hull[k, 1] * uy
        low, high = min(low, at), max(high, at)
    return low, high


@njit(cache=True, nogil=True)
def smallest_rectangle(hull: NDArray[np.int32], count: int, corners: NDArray[np.float64]) -> None:
    """Corners (4, 2), clockwise as seen, of the rectangle of least area around a hull's corners.

    The hull is in halves of a pixel, the rectangle in pixels. One of its sides lies on the hull.
    """
    best = math.inf
    for k in range(count):
        other = k + 1 if k + 1 < count else 0
        dx, dy = float(hull[other, 0] - hull[k, 0]), float(hull[other, 1] - hull[k, 1])
        length = math.hypot(dx, dy)
        if length == 0.0:
            continue
        ux, uy = dx / length, dy / length
        left, right = _extent_along(hull, count, ux, uy)
        low, high = _extent_along(hull, count, -uy, ux)
        area = (right - left) * (high - low)
        if area < best - _SLACK:
            best = area
            for corner in range(4):
                along = left if corner in (0, 3) else right
                across = low if corner < 2 else high
                corners[corner, 0] = 0.5 * (along * ux - across * uy)
                corners[corner, 1] = 0.5 * (along * uy + across * ux)


@njit(cache=True, nogil=True)
def upper_first(corners: NDArray[np.float64]) -> None:
    """Turn four corners, clockwise as seen, so that the first two are the upper edge."""
    best, first = math.inf, 0
    for k in range(4):
        middle = corners[k, 1] + corners[(k + 1) % 4, 1]
        # of two edges equally high, that which leans to the left
        if middle < best - _SLACK or (
            middle < best + _SLACK and corners[k, 0] < corners[first, 0] - _SLACK
        ):
            best, first = min(middle, best), k
    for _ in range(first):
        x, y = corners[0]
        for k in range(3):
            corners[k, 0], corners[k, 1] = corners[k + 1, 0], corners[k + 1, 1]
        corners[3, 0], corners[3, 1] = x, y
