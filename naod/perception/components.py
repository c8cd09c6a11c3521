"""Connected regions of a mask as a picture of labels and a table."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.optimum_field import CELLS_A_WORD, OBJECT
from naod.perception.runs import (
    AREA,
    BOTTOM,
    LEFT,
    RIGHT,
    SUM_X,
    SUM_Y,
    TOP,
    Runs,
    empty_runs,
    find_runs,
)

__all__ = ["AREA", "BOTTOM", "LEFT", "RIGHT", "SUM_X", "SUM_Y", "TOP", "components"]

_NO_DIFFERENCES = np.zeros((0, 0), dtype=np.int32)


@njit(cache=True, nogil=True)
def pad(mask: NDArray[np.uint8], codes: NDArray[np.uint8], hot: NDArray[np.uint8]) -> None:
    """Codes of OBJECT for what is not zero, and which rows have any; the border stays."""
    for i in range(mask.shape[0]):
        line, out = mask[i], codes[i + 1]
        anything = np.uint8(0)
        for j in range(line.size):
            anything |= line[j]
            out[j] = OBJECT if line[j] else 0
        hot[i + 1] = anything


@njit(cache=True, nogil=True)
def paint(runs: Runs, count: int, labels: NDArray[np.int32]) -> None:
    """Write the regions' names where their runs are."""
    for run in range(count):
        labels[runs.rows[run], runs.starts[run] : runs.ends[run] + 1] = runs.names[run]


@njit(cache=True, nogil=True)
def _components(
    mask: NDArray[np.uint8],
    rows: NDArray[np.uint8],
    words: NDArray[np.uint64],
    differences: NDArray[np.int32],
    runs: Runs,
    labels: NDArray[np.int32],
) -> int:
    hot = np.zeros(rows.shape[0], dtype=np.uint8)
    pad(mask, rows, hot)
    count, regions = find_runs(rows, words, hot, differences, runs)
    paint(runs, count, labels)
    return regions


def components(mask: NDArray[np.uint8]) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Regions of touching pixels (eight neighbours) of a mask (h, w), non-zero = inside.

    Returns labels (h, w) int32, 0 outside, and a table (n, 7) int64, row k - 1 for label k, with
    the columns AREA, LEFT, RIGHT, TOP, BOTTOM, SUM_X, SUM_Y in pixels.
    """
    height, width = mask.shape
    labels = np.zeros((height, width), dtype=np.int32)
    pitch = -(-(width + 1) // CELLS_A_WORD) * CELLS_A_WORD
    rows = np.zeros((height + 2, pitch), dtype=np.uint8)
    runs = empty_runs(height, width)
    given = np.ascontiguousarray(mask, dtype=np.uint8)
    regions = _components(given, rows, rows.view(np.uint64), _NO_DIFFERENCES, runs, labels)
    return labels, runs.table[1 : regions + 1, :7]
