"""The points of a boundary that lie on its convex hull, or nearly."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
"""Its multiples are spread evenly, and never in step with anything."""

TIE = 1e-7
"""Of y, added to x: points above each other are in order, others hardly moved."""


@njit(cache=True, nogil=True)
def hull_of(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Corners (m, 2) of the convex hull of points (n, 2), in order around (Andrew 1979)."""
    n = points.shape[0]
    order, hull, count = np.argsort(points[:, 0] + TIE * points[:, 1]), np.empty((2 * n + 1, 2)), 0
    for side in range(2):
        first = count
        for k in range(n):
            x, y = points[order[k if side == 0 else n - 1 - k]]
            while count - first > 1:
                ax, ay = hull[count - 2]
                bx, by = hull[count - 1]
                if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0.0:
                    break
                count -= 1
            hull[count, 0], hull[count, 1] = x, y
            count += 1
        # the last corner of one chain is the first of the other
        count -= 1
    return hull[: max(count, 1)]


@njit(cache=True, nogil=True)
def thinned(points: NDArray[np.float64], every: int) -> NDArray[np.float64]:
    """One point of every so many (n, 2), each from another place among them.

    A boundary goes through rows, from its left side to its right: every second point would be one
    side alone.
    """
    count = points.shape[0] // every
    kept = np.empty((count, 2))
    for k in range(count):
        kept[k] = points[every * k + int(k * GOLDEN % 1.0 * every)]
    return kept


@njit(cache=True, nogil=True)
def convex_points(
    points: NDArray[np.float64], every: int, within: float, most: int
) -> NDArray[np.float64]:
    """About so many of the points (n, 2) that lie no deeper inside the hull of all of them.

    every: only each so many-th is looked at.
    """
    few = thinned(points, every)
    hull = hull_of(few)
    kept, count, last = np.empty(few.shape), 0, hull.shape[0] - 1
    for i in range(few.shape[0]):
        a = hull[last]
        for k in range(hull.shape[0]):
            b = hull[k]
            dx, dy = b[0] - a[0], b[1] - a[1]
            depth = abs(dx * (few[i, 1] - a[1]) - dy * (few[i, 0] - a[0]))
            if depth < within * math.hypot(dx, dy):
                kept[count] = few[i]
                count += 1
                break
            a = b
    return thinned(kept[:count], max(1, round(count / most)))
