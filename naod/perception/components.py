"""Connected regions of a mask, in one pass and a half."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

AREA, LEFT, RIGHT, TOP, BOTTOM, SUM_X, SUM_Y = range(7)
"""Columns of the table that `components` fills."""


@njit(cache=True, nogil=True)
def _root(parents: NDArray[np.int32], label: int) -> int:
    while parents[label] != label:
        parents[label] = parents[parents[label]]
        label = parents[label]
    return label


@njit(cache=True, nogil=True)
def _join(parents: NDArray[np.int32], a: int, b: int) -> int:
    a, b = _root(parents, a), _root(parents, b)
    low, high = min(a, b), max(a, b)
    parents[high] = low
    return low


@njit(cache=True, nogil=True)
def _provisional(
    mask: NDArray[np.uint8], labels: NDArray[np.int32], parents: NDArray[np.int32]
) -> int:
    """First pass: a label per run of touching pixels, meetings noted in `parents`."""
    height, width = mask.shape
    count = 0
    for i in range(height):
        for j in range(width):
            labels[i, j] = 0
            if mask[i, j] == 0:
                continue
            found = 0
            if j > 0:
                found = labels[i, j - 1]
            if i > 0:
                for k in range(max(0, j - 1), min(width, j + 2)):
                    other = labels[i - 1, k]
                    if other not in (0, found):
                        found = other if found == 0 else _join(parents, found, other)
            if found == 0:
                count += 1
                parents[count] = count
                found = count
            labels[i, j] = found
    return count


@njit(cache=True, nogil=True)
def _measure(
    labels: NDArray[np.int32], parents: NDArray[np.int32], table: NDArray[np.int64], names: int
) -> None:
    """Second pass: final labels, and area, box and coordinate sums of each."""
    height, width = labels.shape
    for k in range(names + 1):
        table[k, AREA] = table[k, SUM_X] = table[k, SUM_Y] = 0
        table[k, LEFT], table[k, RIGHT] = width, -1
        table[k, TOP], table[k, BOTTOM] = height, -1
    for i in range(height):
        for j in range(width):
            k = labels[i, j]
            if k == 0:
                continue
            k = parents[k]
            labels[i, j] = k
            table[k, AREA] += 1
            table[k, LEFT] = min(table[k, LEFT], j)
            table[k, RIGHT] = max(table[k, RIGHT], j)
            table[k, TOP] = min(table[k, TOP], i)
            table[k, BOTTOM] = i
            table[k, SUM_X] += j
            table[k, SUM_Y] += i


@njit(cache=True, nogil=True)
def _components(
    mask: NDArray[np.uint8],
    labels: NDArray[np.int32],
    parents: NDArray[np.int32],
    table: NDArray[np.int64],
) -> int:
    count = _provisional(mask, labels, parents)
    names = 0
    parents[0] = 0
    for k in range(1, count + 1):
        if parents[k] == k:
            names += 1
            parents[k] = names
        else:
            # a parent is always smaller, so it has its final name already
            parents[k] = parents[parents[k]]
    _measure(labels, parents, table, names)
    return names


def components(mask: NDArray[np.uint8]) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Regions of touching pixels (eight neighbours) of a mask (h, w), non-zero = inside.

    Returns labels (h, w) int32, 0 outside, and a table (n, 7) int64, row k - 1 for label k, with
    the columns AREA, LEFT, RIGHT, TOP, BOTTOM, SUM_X, SUM_Y in pixels.
    """
    height, width = mask.shape
    labels = np.empty((height, width), dtype=np.int32)
    most = ((height + 1) // 2) * ((width + 1) // 2) + 1
    parents = np.empty(most, dtype=np.int32)
    table = np.empty((most, 7), dtype=np.int64)
    names = _components(np.ascontiguousarray(mask, dtype=np.uint8), labels, parents, table)
    return labels, table[1 : names + 1]


@njit(cache=True, nogil=True)
def _cracks(labels: NDArray[np.int32], wanted: NDArray[np.bool_], out: NDArray[np.float64]) -> int:
    height, width = labels.shape
    count = 0
    for i in range(height):
        for j in range(width):
            inside = wanted[labels[i, j]]
            if j + 1 < width and wanted[labels[i, j + 1]] != inside:
                out[count, 0], out[count, 1] = j + 0.5, i
                count += 1
            if i + 1 < height and wanted[labels[i + 1, j]] != inside:
                out[count, 0], out[count, 1] = j, i + 0.5
                count += 1
    return count


def boundary(labels: NDArray[np.int32], wanted: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Where the regions with `wanted[label]` end inside the picture: (n, 2) x, y in its pixels.

    Points lie half-way between a pixel inside and its neighbour outside. A straight edge passes
    through their mean; the picture's own border is no edge.
    """
    height, width = labels.shape
    out = np.empty((2 * height * width, 2), dtype=np.float64)
    count = _cracks(labels, wanted, out)
    return out[:count].copy()
