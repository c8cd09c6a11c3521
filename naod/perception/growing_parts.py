"""Parts of an object that a ribbon splits, known by the ribbon ending where the object does."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from naod.perception.components import AREA
from naod.perception.growing_cut import PAIRS

Mask = NDArray[np.bool_]

PART_MIN = 0.08
"""Least area of another part, of what is known already."""
GAP_MAX = 0.5
"""How far apart parts may lie, of the side of a square as large as what is known."""
FILL_MIN = 0.75
"""Least share of the hull around both that is either."""
OPEN_MAX = 0.33
"""Of the weight that equal colours would have, what is left at most where the gap ends."""


def hull_of(inside: Mask) -> Mask:
    """The convex hull of a mask (h, w) that is not empty, drawn."""
    rows, columns = np.nonzero(inside)
    hull = cv2.convexHull(np.stack([columns, rows], axis=1).astype(np.int32))
    out = np.zeros(inside.shape, dtype=np.uint8)
    cv2.fillConvexPoly(out, hull, 1)
    return out > 0


def joined(
    inside: Mask, parts: NDArray[np.int32], table: NDArray[np.int64], weights: NDArray[np.int32]
) -> Mask:
    """What is known (h, w) with those other parts, and what lies between, that belong to it.

    parts, table: as `components` has them; weights: (4, h, w), as `pair_weights`.
    """
    side = float(np.sqrt(np.count_nonzero(inside)))
    away = cv2.distanceTransform((~inside).astype(np.uint8), cv2.DIST_L2, 3)
    largest_first = np.argsort(-table[:, AREA], kind="stable")
    for row in largest_first[table[largest_first, AREA] >= PART_MIN * side**2]:
        part = parts == row + 1
        if inside[part].any() or away[part].min() > GAP_MAX * side:
            continue
        both = inside | part
        hull = hull_of(both)
        fills = np.count_nonzero(both) >= FILL_MIN * np.count_nonzero(hull)
        if fills and _openness(hull & ~both, hull, weights) <= OPEN_MAX:
            inside = hull
    return inside


def _openness(gap: Mask, hull: Mask, weights: NDArray[np.int32]) -> float:
    """Mean weight between a gap and what is outside the hull, relative to the greatest there is."""
    total, most = 0.0, 0.0
    height, width = gap.shape
    for weight, (down, right) in zip(weights, PAIRS, strict=True):
        first = slice(0, height - down), slice(max(0, -right), width - max(0, right))
        second = slice(down, height), slice(max(0, right), width - max(0, -right))
        ends = (gap[first] & ~hull[second]) | (gap[second] & ~hull[first])
        total += float(weight[first][ends].sum())
        most += float(weight.max()) * np.count_nonzero(ends)
    return total / most if most else 0.0
