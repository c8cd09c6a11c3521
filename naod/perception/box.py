"""Outline, convex hull and smallest rectangle of regions, from the columns where rows change.

Points are half-way between a pixel inside and its neighbour outside; the picture's own border is no
edge. In halves of a pixel all of them are whole numbers, so the hull is exact.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.memory import LINE, Memory, float64s, int32s
from naod.perception.rectangle import smallest_rectangle, upper_first
from naod.perception.runs import AREA, BOTTOM, LEFT, RIGHT, SUM_X, SUM_Y, TOP, Runs

LEFT_CUT, RIGHT_CUT, TOP_CUT, BOTTOM_CUT = 1, 2, 4, 8
ALL_CUT = 15
"""Bits of the sides of the picture that cut an object."""

_NOTHING = 1 << 30
_POINTS_MIN = 3


class Box(NamedTuple):
    """What is known of one object, and scratch. Pixels are those of the full picture."""

    corners: NDArray[np.float64]  # (4, 2), G, H, J, K
    centre: NDArray[np.float64]  # (2,)
    boundary: NDArray[np.float64]  # (points at most, 2)
    breaks: NDArray[np.int32]  # columns where rows enter and leave the object, row after row
    first: NDArray[np.int32]  # (h + 2,), where a row's breaks begin
    ends: NDArray[np.int32]  # (2 h + 1, 2), least and greatest x of a level, in halves of a pixel
    hull: NDArray[np.int32]  # (4 h + 4, 2), x and y in halves of a pixel


class Found(NamedTuple):
    """The part of a box that is the answer."""

    corners: NDArray[np.float64]
    centre: NDArray[np.float64]
    boundary: NDArray[np.float64]


@njit(cache=True, nogil=True)
def found_in(memory: Memory, start: int, height: int, width: int) -> tuple[Found, int]:
    """Room for an answer, and where memory is free again."""
    most = 2 * height * width + 1
    corners, at = float64s(memory, start, 8)
    centre, at = float64s(memory, at, 2)
    boundary, at = float64s(memory, at, 2 * most)
    return Found(corners.reshape((4, 2)), centre, boundary.reshape((most, 2))), at


def bytes_of_found(height: int, width: int) -> int:
    """Memory that an answer takes."""
    return 32 * height * width + 8 * LINE


@njit(cache=True, nogil=True)
def box_in(memory: Memory, start: int, found: Found, height: int, width: int) -> tuple[Box, int]:
    """Scratch for an answer, and where memory is free again."""
    breaks, at = int32s(memory, start, height * (width + 1) + 1)
    first, at = int32s(memory, at, height + 3)
    ends, at = int32s(memory, at, 4 * height + 2)
    hull, at = int32s(memory, at, 8 * height + 8)
    levels, corners = ends.reshape((2 * height + 1, 2)), hull.reshape((4 * height + 4, 2))
    box = Box(found.corners, found.centre, found.boundary, breaks, first, levels, corners)
    return box, at


def bytes_of_box(height: int, width: int) -> int:
    """Memory that scratch for an answer takes, at the most."""
    return 4 * height * (width + 16) + 16 * LINE


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
def _turns(hull: NDArray[np.int32], count: int, x: int, y: int) -> bool:
    """Whether the last point of a chain stays a corner when (x, y) follows."""
    ax, ay = hull[count - 2, 0], hull[count - 2, 1]
    bx, by = hull[count - 1, 0], hull[count - 1, 1]
    cross = np.int64(bx - ax) * (y - ay) - np.int64(by - ay) * (x - ax)
    return cross > 0


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
            while count - base > 1 and not _turns(hull, count, x, level):
                count -= 1
            hull[count, 0], hull[count, 1] = x, level
            count += 1
    return count


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
def _to_full(points: NDArray[np.float64], grain_px: float) -> None:
    """A mask pixel's centre is that of the block it stands for."""
    for k in range(points.shape[0]):
        points[k, 0] = (points[k, 0] + 0.5) * grain_px - 0.5
        points[k, 1] = (points[k, 1] + 0.5) * grain_px - 0.5


@njit(cache=True, nogil=True)
def measure_box(
    box: Box, extent: NDArray[np.int64], height: int, width: int, grain_px: float
) -> tuple[int, int]:
    """Fill a box from its breaks and its line in the table of regions, in full pixels.

    Returns the number of boundary points and the sides cut.
    """
    top, bottom = extent[TOP], extent[BOTTOM]
    points = _trace(box, top, bottom, height, width)
    cut = sides_cut(extent, height, width)
    if points < _POINTS_MIN or cut == ALL_CUT:
        _upright(extent, box.corners)
    else:
        first = 2 * top - 1 if top > 0 else 0
        last = 2 * bottom + 1 if bottom < height - 1 else 2 * bottom
        smallest_rectangle(box.hull, _hull(box, first, last), box.corners)
        upper_first(box.corners)
    box.centre[0] = extent[SUM_X] / extent[AREA]
    box.centre[1] = extent[SUM_Y] / extent[AREA]
    _to_full(box.corners, grain_px)
    _to_full(box.boundary[:points], grain_px)
    _to_full(box.centre.reshape((1, 2)), grain_px)
    return points, cut
