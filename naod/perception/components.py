"""Connected regions of a mask as a picture of labels and a table."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.bits import pack, words_of
from naod.perception.runs import (
    AREA,
    BOTTOM,
    LEFT,
    RIGHT,
    SUM_X,
    SUM_Y,
    TOP,
    find_runs,
    fresh_runs,
    paint,
)

__all__ = ["AREA", "BOTTOM", "LEFT", "RIGHT", "SUM_X", "SUM_Y", "TOP", "components"]


@njit(cache=True, nogil=True)
def _components(mask: NDArray[np.uint8]) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    height, width = mask.shape
    labels = np.zeros((height, width), dtype=np.int32)
    bits = np.empty(height * words_of(width), dtype=np.uint64)
    pack(mask, bits)
    runs = fresh_runs(height, width)
    count, regions = find_runs(bits, height, width, runs)
    paint(runs, count, labels)
    return labels, runs.table[1 : regions + 1, : SUM_Y + 1].copy()


def components(mask: NDArray[np.uint8]) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Regions of touching pixels (eight neighbours) of a mask (h, w), non-zero = inside.

    Returns labels (h, w) int32, 0 outside, and a table (n, 7) int64, row k - 1 for label k, with
    the columns AREA, LEFT, RIGHT, TOP, BOTTOM, SUM_X, SUM_Y in pixels.
    """
    found: tuple[NDArray[np.int32], NDArray[np.int64]] = _components(
        np.ascontiguousarray(mask, dtype=np.uint8)
    )
    return found
