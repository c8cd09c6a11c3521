"""Outline, convex hull and smallest rectangle of regions, from the columns where rows change.

Points are half-way between a pixel inside and its neighbour outside; the picture's own border is no
edge. In halves of a pixel all of them are whole numbers, so the hull is exact.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.runs import AREA, BOTTOM, LEFT, RIGHT, SUM_X, SUM_Y, TOP, Runs

LEFT_CUT, RIGHT_CUT, TOP_CUT, BOTTOM_CUT = 1, 2, 4, 8
"""Bits of the sides of the picture that cut an object."""

ALL_CUT = 15
_NOTHING = 1 << 30
_POINTS_MIN = 3
_SLACK = 1e-9


class Box(NamedTuple):
    """What is known of one object, and scratch. Pixels are those of the full picture."""

    corners: NDArray[np.float64]  # (4, 2), G, H, J, K
    centre: NDArray[np.float64]  # (2,)
    boundary: NDArray[np.float64]  # (points at most, 2)
    breaks: NDArray[np.int32]  # columns where rows enter and leave the object, row after row
    first: NDArray[np.int32]  # (h + 2,), where a row's breaks begin
    ends: NDArray[np.int32]  # (2 h + 1, 2), least and greatest x of a level, in halves of a pixel
    hull: NDArray[np.int32]  # (4 h + 4, 2), x and y in halves of a pixel


def empty_box(height: int, width: int) -> Box:
    """All the memory that masks of this size ever need."""
    return Box(
        corners=np.zeros((4, 2)),
        centre=np.zeros(2),
        boundary=np.empty((2 * height * width + 1, 2)),
        breaks=np.zeros(height * (width + 1) + 1, dtype=np.int32),
        first=np.zeros(height + 3, dtype=np.int32),
        ends=np.zeros((2 * height + 1, 2), dtype=np.int32),
        hull=np.zeros((4 * height + 4, 2), dtype=np.int32),
    )


@njit(cache=True, nogil=True)
def breaks_of_region(runs: Runs, count: int, name: int, box: Box) -> None:
    """Breaks of all rows of one region."""
    top, bottom = runs.table[name, TOP], runs.table[name, BOTTOM]
    at, row = 0, top
    box.first[top] = 0
    for run in range(count):
        if runs.names[run] != name:
            continue
        while row < runs.rows[run]:
            row += 1
            box.first[row] = at
        box.breaks[at], box.breaks[at + 1] = runs.starts[run], runs.ends[run] + 1
        at += 2
    box.first[bottom + 1] = at


@njit(cache=True, nogil=True)
def breaks_of_labels(
    labels: NDArray[np.int32], wanted: NDArray[np.bool_], extent: NDArray[np.int64], box: Box
) -> None:
    """Breaks of all regions with `wanted[label]`, which lie within the extent."""
    at = 0
    for i in range(extent[TOP], extent[BOTTOM] + 1):
        box.first[i] = at
        inside = False
        for j in range(extent[LEFT], extent[RIGHT] + 1):
            if wanted[labels[i, j]] != inside:
                inside = not inside
                box.breaks[at] = j
                at += 1
        if inside:
            box.breaks[at] = extent[RIGHT] + 1
            at += 1
    box.first[extent[BOTTOM] + 1] = at


@njit(cache=True, nogil=True)
def _sides_of_row(box: Box, row: int, width: int, points: int) -> int:
    """Points to the left and right of a row's stretches; how many points there are then."""
    ends = box.ends[2 * row]
    ends[0], ends[1] = _NOTHING, -_NOTHING
    for k in range(box.first[row], box.first[row + 1]):
        column = box.breaks[k]
        if 0 < column < width:
            x = np.int32(2 * column - 1)
            ends[0], ends[1] = min(ends[0], x), max(ends[1], x)
            box.boundary[points, 0], box.boundary[points, 1] = 0.5 * x, row
            points += 1
    return points


@njit(cache=True, nogil=True)
def _between_rows(
    box: Box, row: int, above: tuple[int, int], below: tuple[int, int], points: int
) -> int:
    """Points between a row and the one above it, given both rows' breaks from and to."""
    ends = box.ends[2 * row - 1]
    ends[0], ends[1] = _NOTHING, -_NOTHING
    a, b = above[0], below[0]
    begun = _NOTHING
    while a < above[1] or b < below[1]:
        x = box.breaks[a] if a < above[1] else _NOTHING
        y = box.breaks[b] if b < below[1] else _NOTHING
        a += x <= y
        b += y <= x
        if x == y:
            # both rows change here: what lies between them is as it was
            continue
        column = min(x, y)
        if begun == _NOTHING:
            begun = column
            continue
        ends[0], ends[1] = min(ends[0], 2 * begun), max(ends[1], 2 * (column - 1))
        for j in range(begun, column):
            box.boundary[points, 0], box.boundary[points, 1] = j, row - 0.5
            points += 1
        begun = _NOTHING
    return points


@njit(cache=True, nogil=True)
def _trace(box: Box, top: int, bottom: int, height: int, width: int) -> int:
    """All boundary points, and the ends of all levels; how many points."""
    points = 0
    for row in range(top, bottom + 2):
        inside, was = row <= bottom, row > top
        below = (box.first[row], box.first[row + 1]) if inside else (np.int32(0), np.int32(0))
        above = (box.first[row - 1], box.first[row]) if was else (np.int32(0), np.int32(0))
        if 0 < row < height:
            points = _between_rows(box, row, above, below, points)
        if inside:
            points = _sides_of_row(box, row, width, points)
    return points


@njit(cache=True, nogil=True)
def _turns(hull: NDArray[np.int32], count: int, x: int, y: int, side: int) -> bool:
    """Whether the last point of a chain stays a corner when (x, y) follows."""
    ax, ay = hull[count - 2, 0], hull[count - 2, 1]
    bx, by = hull[count - 1, 0], hull[count - 1, 1]
    cross = np.int64(bx - ax) * (y - ay) - np.int64(by - ay) * (x - ax)
    return side * cross > 0


@njit(cache=True, nogil=True)
def _hull(box: Box, top: int, bottom: int) -> int:
    """Corners of the hull of all levels, up the left side and down the right one; how many."""
    hull, count = box.hull, 0
    for side in range(2):
        base = count
        for step in range(bottom - top + 1):
            level = bottom - step if side == 0 else top + step
            x = box.ends[level, side]
            if abs(x) == _NOTHING:
                continue
            # going up the left side, or down the right one, a corner bends to the right
            while count - base > 1 and not _turns(hull, count, x, level, 1):
                count -= 1
            hull[count, 0], hull[count, 1] = x, level
            count += 1
    return count


@njit(cache=True, nogil=True)
def _extent_along(hull: NDArray[np.int32], count: int, ux: float, uy: float) -> tuple[float, float]:
    low, high = math.inf, -math.inf
    for k in range(count):
        at = hull[k, 0] * ux + hull[k, 1] * uy
        low, high = min(low, at), max(high, at)
    return low, high


@njit(cache=True, nogil=True)
def _smallest(hull: NDArray[np.int32], count: int, corners: NDArray[np.float64]) -> None:
    """Corners of the rectangle of least area, one of whose sides lies on the hull's."""
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
def _upper_first(corners: NDArray[np.float64]) -> None:
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


@njit(cache=True, nogil=True)
def sides_cut(extent: NDArray[np.int64], height: int, width: int) -> int:
    """Bits of the picture's sides that an extent touches."""
    cut = LEFT_CUT * (extent[LEFT] == 0) + RIGHT_CUT * (extent[RIGHT] == width - 1)
    return int(cut + TOP_CUT * (extent[TOP] == 0) + BOTTOM_CUT * (extent[BOTTOM] == height - 1))


@njit(cache=True, nogil=True)
def _upright(extent: NDArray[np.int64], corners: NDArray[np.float64]) -> None:
    left, right = extent[LEFT] - 0.5, extent[RIGHT] + 0.5
    top, bottom = extent[TOP] - 0.5, extent[BOTTOM] + 0.5
    corners[0, 0], corners[1, 0], corners[2, 0], corners[3, 0] = left, right, right, left
    corners[0, 1], corners[1, 1], corners[2, 1], corners[3, 1] = top, top, bottom, bottom


@njit(cache=True, nogil=True)
def measure_box(
    box: Box, extent: NDArray[np.int64], height: int, width: int, grain_px: float
) -> tuple[int, int]:
    """Fill a box from its breaks and its line in the table of regions, in full pixels.

    A mask pixel's centre is that of the block it stands for. Returns the number of boundary points
    and the sides cut.
    """
    top, bottom = extent[TOP], extent[BOTTOM]
    points = _trace(box, top, bottom, height, width)
    cut = sides_cut(extent, height, width)
    if points < _POINTS_MIN or cut == ALL_CUT:
        _upright(extent, box.corners)
    else:
        levels = max(2 * top - 1, 1), min(2 * bottom + 1, 2 * height - 3)
        first, last = min(levels[0], 2 * top), max(levels[1], 2 * bottom)
        _smallest(box.hull, _hull(box, first, last), box.corners)
        _upper_first(box.corners)
    box.centre[0] = extent[SUM_X] / extent[AREA]
    box.centre[1] = extent[SUM_Y] / extent[AREA]
    for points_px in (box.corners, box.boundary[:points]):
        for k in range(points_px.shape[0]):
            points_px[k, 0] = (points_px[k, 0] + 0.5) * grain_px - 0.5
            points_px[k, 1] = (points_px[k, 1] + 0.5) * grain_px - 0.5
    box.centre[0] = (box.centre[0] + 0.5) * grain_px - 0.5
    box.centre[1] = (box.centre[1] + 0.5) * grain_px - 0.5
    return points, cut
