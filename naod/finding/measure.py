"""What speaks for a group of regions being the object, measured in one go."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.finding.hue import CLIP, Own, look_at_middle
from naod.finding.hull import Points, four_sides, hull_of_rows, row_ends, smallest_box
from naod.finding.silhouette import (
    CUT_ACROSS,
    CUT_ALONG,
    LYING,
    MISFIT,
    OUTLINE_MAX,
    SCALE,
    SHOWN,
    TURN_AWAY,
    cut_outline,
    cylinder_outline,
    rectangle_outline,
)
from naod.perception.components import BOTTOM, LEFT, RIGHT, TOP
from naod.perception.energy import STEPS

NO_SHAPE, CYLINDER, RECTANGLE = range(3)

COLOUR, RING, PIXELS, FILL, GAP, ASPECT, TURN, ON_SIDE = range(8)
METRE, X, Y, CORE, HUE, TONE, SHARE = range(8, 15)
MEASURES = 15
"""Columns: mean log-likelihood ratio (nat, positive = object) of the group's pixels inside the
outline, and of all around it; mask pixels inside; share of those that are the group's; mean
distance of hull and outline in tolerances; misfit of proportions in tolerances; a rectangle's turn
out of the picture's plane (rad); 1 where it lies; mask pixels per metre; middle of the box; ratio
(nat) that a quarter of the pixels exceed, which blur leaves alone as long as it is short; how
far its hue and tone are from the object's in tolerances, -1 and 0 where there is no picture; share
of the object that the picture's border leaves, at most."""

USUAL_PIXELS = 160 * 120
"""Pixels are counted as of a mask of this size: what matters is their share of the picture."""

GAP_PX, GAP_SHARE = 0.5, 0.02
ASPECT_PX, ASPECT_SHARE = 1.5, 0.06
"""Tolerances: of a hull's and a box's sides, in mask pixels and in shares of the size."""

GAP_BLUR, ASPECT_BLUR = 0.1, 0.25
"""Of the length of the motion blur that adds to them: a smeared side may count or not."""

_BINS_A_NAT = 8
_BINS = int(CLIP) * _BINS_A_NAT


@njit(cache=True, nogil=True)
def _spans(outline: Points, count: int, spans: NDArray[np.float64]) -> None:
    """Where each row meets a convex polygon, (h, 2); from inf to -inf where it does not."""
    for i in range(spans.shape[0]):
        spans[i, 0], spans[i, 1] = np.inf, -np.inf
    for k in range(count):
        n = k + 1 if k + 1 < count else 0
        x0, y0, x1, y1 = outline[k, 0], outline[k, 1], outline[n, 0], outline[n, 1]
        if y0 > y1:
            x0, y0, x1, y1 = x1, y1, x0, y0
        if y1 - y0 < 1e-9:
            continue
        for i in range(max(math.ceil(y0), 0), min(math.floor(y1), spans.shape[0] - 1) + 1):
            x = x0 + (i - y0) * (x1 - x0) / (y1 - y0)
            spans[i, 0], spans[i, 1] = min(spans[i, 0], x), max(spans[i, 1], x)


@njit(cache=True, nogil=True)
def _wider(spans: NDArray[np.float64], by: int, wide: NDArray[np.float64]) -> None:
    """Spans of the same grown by so many pixels to every side."""
    height = spans.shape[0]
    for i in range(height):
        low, high = np.inf, -np.inf
        for k in range(max(i - by, 0), min(i + by, height - 1) + 1):
            low, high = min(low, spans[k, 0]), max(high, spans[k, 1])
        wide[i, 0], wide[i, 1] = low - by, high + by


@njit(cache=True, nogil=True)
def _columns(span: NDArray[np.float64], width: int) -> tuple[int, int]:
    """First and one past the last pixel of a span within the picture."""
    if span[0] > span[1]:
        return 0, 0
    first, last = max(math.ceil(span[0]), 0), min(math.floor(span[1]), width - 1)
    return (first, last + 1) if last >= first else (0, 0)


@njit(cache=True, nogil=True)
def _clipped(difference: int) -> float:
    return min(max(-difference / STEPS, -CLIP), CLIP)


@njit(cache=True, nogil=True)
def _colour_inside(
    labels: NDArray[np.int32],
    wanted: NDArray[np.bool_],
    differences: NDArray[np.int32],
    spans: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    inside, own, many = 0.0, 0, 0
    counts = np.zeros(_BINS, dtype=np.int64)
    for i in range(labels.shape[0]):
        first, last = _columns(spans[i], labels.shape[1])
        many += last - first
        for j in range(first, last):
            if wanted[labels[i, j]]:
                ratio = _clipped(differences[i, j])
                inside += ratio
                own += 1
                counts[min(max(int(ratio * _BINS_A_NAT), 0), _BINS - 1)] += 1
    out[COLOUR] = inside / max(own, 1)
    out[PIXELS] = many
    out[FILL] = own / max(many, 1)
    surer, level = 0, _BINS
    while level > 0 and 4 * surer < own:
        level -= 1
        surer += counts[level]
    out[CORE] = (level + 0.5) / _BINS_A_NAT


@njit(cache=True, nogil=True)
def _colour_around(
    differences: NDArray[np.int32], spans: NDArray[np.float64], ring: int, out: NDArray[np.float64]
) -> None:
    """Mean ratio in a ring around the spans that leaves a pixel's room."""
    height, width = differences.shape
    near, far = np.empty_like(spans), np.empty_like(spans)
    _wider(spans, 1, near)
    _wider(spans, 1 + ring, far)
    around, many = 0.0, 0
    for i in range(height):
        start, stop = _columns(far[i], width)
        first, last = _columns(near[i], width)
        if last == 0:
            first = last = start
        for j in range(start, first):
            around += _clipped(differences[i, j])
        for j in range(last, stop):
            around += _clipped(differences[i, j])
        many += first - start + stop - last
    out[RING] = around / many if many else -CLIP


@njit(cache=True, nogil=True)
def _difference(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Pixels in one of two sets of spans only."""
    total = 0.0
    for i in range(a.shape[0]):
        long_a, long_b = max(a[i, 1] - a[i, 0], 0.0), max(b[i, 1] - b[i, 0], 0.0)
        low, high = max(a[i, 0], b[i, 0]), min(a[i, 1], b[i, 1])
        total += long_a + long_b - 2.0 * max(high - low, 0.0)
    return total


@njit(cache=True, nogil=True)
def _shaped(
    hull: Points,
    corners: int,
    box: NDArray[np.float64],
    shape: tuple[int, float, float],
    cut: int,
    blur: float,
    outline: Points,
    out: NDArray[np.float64],
) -> int:
    """The shape's outline for a hull; the hull's own where there is no shape, or it is cut off."""
    kind, half_width, half_height = shape
    found, count = np.zeros(5), 0
    found[SHOWN] = 1.0
    if kind != NO_SHAPE and cut:
        round_ = kind == CYLINDER
        cut_outline(box, round_, 2.0 * half_width, 2.0 * half_height, cut, found)
    elif kind == CYLINDER:
        count = cylinder_outline(box, half_width, 2.0 * half_height, found, outline)
    elif kind == RECTANGLE:
        quadrilateral = np.empty((corners, 2))
        count = four_sides(hull, corners, quadrilateral)
        outline[:4] = quadrilateral[:4]
        if count == 4:
            rectangle_outline(outline, 2.0 * half_width, 2.0 * half_height, found)
        else:
            found[SCALE] = max(box[4] / (2.0 * half_width), box[5] / (2.0 * half_height))
            count = 0
    across, along = max(box[4], 1.0), max(box[5], 1.0)
    unsure = ASPECT_PX + ASPECT_BLUR * blur
    allowed = math.hypot(unsure / across, unsure / along) + ASPECT_SHARE
    out[ASPECT] = found[MISFIT] / allowed
    out[TURN], out[ON_SIDE] = found[TURN_AWAY], found[LYING]
    out[METRE], out[SHARE] = found[SCALE], found[SHOWN]
    if count == 0:
        for k in range(corners):
            outline[k] = hull[k]
        return corners
    return count


@njit(cache=True, nogil=True)
def measure(
    labels: NDArray[np.int32],
    table: NDArray[np.int64],
    wanted: NDArray[np.bool_],
    differences: NDArray[np.int32],
    shape: tuple[int, float, float],
    cut: int,
    blur: float,
    picture: NDArray[np.uint8],
    own: Own,
    out: NDArray[np.float64],
) -> None:
    """Measures (MEASURES,) of the regions with `wanted[label]`.

    shape: kind, half width (or radius) and half height in m. cut: as in `silhouette`. blur: its
    length in mask pixels, 0 where nobody knows. picture, own: as `look_at_middle` has them.
    """
    height, width = labels.shape
    top, bottom, left, right = height, -1, width, -1
    for k in range(table.shape[0]):
        if wanted[k + 1]:
            top, bottom = min(top, table[k, TOP]), max(bottom, table[k, BOTTOM])
            left, right = min(left, table[k, LEFT]), max(right, table[k, RIGHT])
    ends = np.empty((height, 2), dtype=np.int64)
    row_ends(labels, wanted, top, bottom, left, right, ends)
    hull = np.empty((4 * (bottom - top + 1), 2))
    corners = hull_of_rows(ends, top, bottom, hull)
    box = np.empty(6)
    smallest_box(hull, corners, box)
    outline = np.empty((max(corners, OUTLINE_MAX), 2))
    count = _shaped(hull, corners, box, shape, cut, blur, outline, out)
    least = max(min(box[4], box[5]), 1.0)
    ring = min(max(round(0.15 * least), 2), 6)
    # nothing is looked at beyond these rows
    low = max(math.floor(min(outline[:count, 1].min(), top)) - ring - 2, 0)
    high = min(math.ceil(max(outline[:count, 1].max(), bottom)) + ring + 3, height)
    hull[:corners, 1] -= low
    outline[:count, 1] -= low
    spans, whole = np.empty((high - low, 2)), np.empty((high - low, 2))
    _spans(hull, corners, whole)
    _spans(outline, count, spans)
    _colour_inside(labels[low:high], wanted, differences[low:high], spans, out)
    _colour_around(differences[low:high], spans, ring, out)
    out[PIXELS] *= USUAL_PIXELS / labels.size
    around = 2.0 * (box[4] + box[5])
    out[GAP] = _difference(spans, whole) / around
    out[GAP] /= GAP_PX + GAP_SHARE * least + GAP_BLUR * blur
    out[X], out[Y] = box[0], box[1]
    out[HUE] = -1.0
    if picture.size:
        out[HUE], out[TONE] = look_at_middle(picture, labels, wanted, box, own)


@njit(cache=True, nogil=True)
def _cut_of(table: NDArray[np.int64], wanted: NDArray[np.bool_], height: int, width: int) -> int:
    cut = 0
    for k in range(table.shape[0]):
        if wanted[k + 1]:
            if table[k, LEFT] == 0 or table[k, RIGHT] == width - 1:
                cut |= CUT_ACROSS
            if table[k, TOP] == 0 or table[k, BOTTOM] == height - 1:
                cut |= CUT_ALONG
    return cut


@njit(cache=True, nogil=True)
def measure_groups(
    labels: NDArray[np.int32],
    table: NDArray[np.int64],
    differences: NDArray[np.int32],
    chosen: NDArray[np.int64],
    groups: NDArray[np.int64],
    shape: tuple[int, float, float],
    blur: float,
    picture: NDArray[np.uint8],
    own: Own,
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Measures (m, MEASURES) of groups as `groups_of` gives them, and the borders that cut each.

    blur: length of the motion blur in mask pixels, 0 where nobody knows. picture, own: as
    `look_at_middle` has them, an empty picture where there is none.
    """
    out = np.zeros((len(groups), MEASURES))
    cuts = np.zeros(len(groups), dtype=np.int64)
    wanted = np.zeros(table.shape[0] + 1, dtype=np.bool_)
    for g in range(len(groups)):
        wanted[:] = False
        for n in range(len(chosen)):
            wanted[chosen[n] + 1] = bool(groups[g] >> n & 1)
        cuts[g] = _cut_of(table, wanted, *labels.shape)
        measure(labels, table, wanted, differences, shape, cuts[g], blur, picture, own, out[g])
    return out, cuts
