"""Convex hulls of regions and the boxes and quadrilaterals around them, in mask pixels."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

Points = NDArray[np.float64]


@njit(cache=True, nogil=True)
def row_ends(
    labels: NDArray[np.int32],
    wanted: NDArray[np.bool_],
    top: int,
    bottom: int,
    left: int,
    right: int,
    ends: NDArray[np.int64],
) -> None:
    """First and last column of the wanted regions in each row of a box, (h, 2); 0, -1 for none."""
    for i in range(top, bottom + 1):
        ends[i, 0], ends[i, 1] = 0, -1
        for j in range(left, right + 1):
            if wanted[labels[i, j]]:
                ends[i, 0] = j
                break
        else:
            continue
        for j in range(right, left - 1, -1):
            if wanted[labels[i, j]]:
                ends[i, 1] = j
                break


@njit(cache=True, nogil=True)
def _push(hull: Points, first: int, count: int, x: float, y: float, sign: float) -> int:
    """Add a point below all others to a chain that keeps turning one way."""
    while count - first >= 2:
        ax, ay = hull[count - 1, 0] - hull[count - 2, 0], hull[count - 1, 1] - hull[count - 2, 1]
        bx, by = x - hull[count - 1, 0], y - hull[count - 1, 1]
        if sign * (ax * by - ay * bx) > 1e-9:
            break
        count -= 1
    hull[count, 0], hull[count, 1] = x, y
    return count + 1


@njit(cache=True, nogil=True)
def hull_of_rows(ends: NDArray[np.int64], top: int, bottom: int, hull: Points) -> int:
    """Corners of the hull of whole pixels, clockwise as seen from the top; returns how many.

    hull: room for 4 (bottom - top + 1) points.
    """
    count = 0
    for i in range(top, bottom + 1):
        if ends[i, 1] >= 0:
            for y in (i - 0.5, i + 0.5):
                count = _push(hull, 0, count, ends[i, 1] + 0.5, y, 1.0)
    first = count
    for i in range(bottom, top - 1, -1):
        if ends[i, 1] >= 0:
            for y in (i + 0.5, i - 0.5):
                count = _push(hull, first, count, ends[i, 0] - 0.5, y, 1.0)
    return count


@njit(cache=True, nogil=True)
def polygon_area(points: Points, count: int) -> float:
    """Of a simple polygon, points (count, 2) clockwise as seen."""
    total = 0.0
    for k in range(count):
        n = k + 1 if k + 1 < count else 0
        total += points[k, 0] * points[n, 1] - points[n, 0] * points[k, 1]
    return 0.5 * total


@njit(cache=True, nogil=True)
def smallest_box(hull: Points, count: int, box: NDArray[np.float64]) -> None:
    """Rectangle of least area around a hull into box (6,): x, y, ux, uy, across, along.

    (x, y) is its middle, u the unit vector of the side nearer to the vertical, downwards.
    """
    least = np.inf
    for k in range(count):
        n = k + 1 if k + 1 < count else 0
        ex, ey = hull[n, 0] - hull[k, 0], hull[n, 1] - hull[k, 1]
        length = math.hypot(ex, ey)
        if length < 1e-9:
            continue
        ex, ey = ex / length, ey / length
        if abs(ex) > abs(ey):
            ex, ey = -ey, ex
        if ey < 0.0:
            ex, ey = -ex, -ey
        low_u = low_v = np.inf
        high_u = high_v = -np.inf
        for m in range(count):
            u = hull[m, 0] * ex + hull[m, 1] * ey
            v = hull[m, 0] * ey - hull[m, 1] * ex
            low_u, high_u = min(low_u, u), max(high_u, u)
            low_v, high_v = min(low_v, v), max(high_v, v)
        area = (high_u - low_u) * (high_v - low_v)
        if area < least - 1e-9:
            least = area
            u, v = 0.5 * (low_u + high_u), 0.5 * (low_v + high_v)
            box[0], box[1] = u * ex + v * ey, u * ey - v * ex
            box[2], box[3] = ex, ey
            box[4], box[5] = high_v - low_v, high_u - low_u


@njit(cache=True, nogil=True)
def _without(corners: Points, count: int, k: int, at: NDArray[np.float64]) -> float:
    """Area that is added when edge k is dropped and its neighbours meet, at `at`; inf if never."""
    a, b = corners[(k - 1) % count], corners[k]
    c, d = corners[(k + 1) % count], corners[(k + 2) % count]
    bx, by, dx, dy = b[0] - a[0], b[1] - a[1], c[0] - d[0], c[1] - d[1]
    turn = bx * dy - by * dx
    # the neighbours must meet beyond the edge, not on the other side of the hull
    if turn > -1e-9:
        return np.inf
    s = ((c[0] - b[0]) * dy - (c[1] - b[1]) * dx) / turn
    at[0], at[1] = b[0] + s * bx, b[1] + s * by
    area = (c[0] - b[0]) * (at[1] - b[1]) - (c[1] - b[1]) * (at[0] - b[0])
    return 0.5 * abs(area)


@njit(cache=True, nogil=True)
def four_sides(hull: Points, count: int, corners: Points) -> int:
    """Quadrilateral around a hull, edges dropped one by one where that adds least area.

    corners: room for `count` points; the first so many as returned are filled, 4 unless the hull
    has fewer corners or is too odd.
    """
    for k in range(count):
        corners[k] = hull[k]
    at, best_at = np.empty(2), np.empty(2)
    while count > 4:
        least, best = np.inf, -1
        for k in range(count):
            area = _without(corners, count, k, at)
            if area < least:
                least, best = area, k
                best_at[0], best_at[1] = at[0], at[1]
        if best < 0:
            return count
        corners[best] = best_at
        drop = (best + 1) % count
        for k in range(drop, count - 1):
            corners[k] = corners[k + 1]
        count -= 1
    return count
