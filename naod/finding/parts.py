"""Parts of regions, parted by the picture's own edges.

What has the very colour of the object and touches it in the picture makes one region with it, and
no stricter level tells them apart. Where one thing ends before another, light and shade mostly
leave a line all the same.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.finding.hue import add_block, block_of
from naod.finding.regions import Regions
from naod.perception.blob import evidence
from naod.perception.components import AREA, BOTTOM, LEFT, RIGHT, SUM_X, SUM_Y, TOP, components

EDGE_LEVELS = 6.0
"""8-bit levels of Y, U and V together from one mask pixel to the next: more is an edge. A picture's
noise is a fifth of that after reduction, a can's shading half."""

GROWN_PX = 2
"""Mask pixels by which parts grow towards each other afterwards: a sharp edge takes one of either,
a blurred one two."""

AROUND_MAX = -0.5
"""Nat: what is around a part is another thing, however like it; of its colour it may well be."""


def parts_of(regions: Regions, picture: NDArray[np.uint8]) -> Regions:
    """Connected parts of regions within which nothing changes at once.

    picture: (H, W, 2) uint8 YUYV, read-only, a block of it behind each pixel of the regions. Edges
    between a region and what is outside do not count, it ends there anyway.
    """
    colours = np.empty((*regions.labels.shape, 3), dtype=np.float32)
    labels, seeds = components(_even(regions.labels, picture, colours))
    own = _means(labels, colours, len(seeds))
    _grow(labels, regions.labels, GROWN_PX)
    table = _table(labels, len(seeds))
    told = evidence(labels, regions.differences, len(table))
    return Regions(labels, table, told, regions.differences, own, AROUND_MAX)


@njit(cache=True, nogil=True)
def _step(a: NDArray[np.float32], b: NDArray[np.float32]) -> float:
    return math.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)


@njit(cache=True, nogil=True)
def _even(
    labels: NDArray[np.int32], picture: NDArray[np.uint8], colours: NDArray[np.float32]
) -> NDArray[np.uint8]:
    """1 where a region's pixel is no edge to its neighbours in the region; fills their colours."""
    height, width = labels.shape
    block, sums = block_of(picture, height), np.empty(4)
    even = np.zeros((height, width), dtype=np.uint8)
    for i in range(height):
        for j in range(width):
            if labels[i, j] == 0:
                continue
            sums[:] = 0.0
            add_block(picture, i, j, block, 1, sums)
            colours[i, j] = sums[:3] / sums[3]
            even[i, j] = 1
            if i and labels[i - 1, j] and _step(colours[i, j], colours[i - 1, j]) > EDGE_LEVELS:
                even[i, j] = even[i - 1, j] = 0
            if j and labels[i, j - 1] and _step(colours[i, j], colours[i, j - 1]) > EDGE_LEVELS:
                even[i, j] = even[i, j - 1] = 0
    return even


@njit(cache=True, nogil=True)
def _means(
    labels: NDArray[np.int32], colours: NDArray[np.float32], count: int
) -> NDArray[np.float64]:
    """(count, 3) mean colours of labels."""
    sums, many = np.zeros((count, 3)), np.zeros(count)
    for i in range(labels.shape[0]):
        for j in range(labels.shape[1]):
            k = labels[i, j] - 1
            if k >= 0:
                many[k] += 1.0
                for c in range(3):
                    sums[k, c] += colours[i, j, c]
    for k in range(count):
        sums[k] /= many[k]
    return sums


@njit(cache=True, nogil=True)
def _grow(labels: NDArray[np.int32], within: NDArray[np.int32], steps: int) -> None:
    """Labels grow into what has none, all at the same pace, where `within` has one."""
    height, width = labels.shape
    for _ in range(steps):
        before = labels.copy()
        for i in range(height):
            for j in range(width):
                if within[i, j] == 0 or before[i, j]:
                    continue
                near = 0
                if i and before[i - 1, j]:
                    near = before[i - 1, j]
                elif i + 1 < height and before[i + 1, j]:
                    near = before[i + 1, j]
                elif j and before[i, j - 1]:
                    near = before[i, j - 1]
                elif j + 1 < width:
                    near = before[i, j + 1]
                labels[i, j] = near


@njit(cache=True, nogil=True)
def _table(labels: NDArray[np.int32], count: int) -> NDArray[np.int64]:
    """Rows (count, 7) as `components` has them."""
    height, width = labels.shape
    table = np.zeros((count, 7), dtype=np.int64)
    for k in range(count):
        table[k, LEFT], table[k, TOP] = width, height
        table[k, RIGHT] = table[k, BOTTOM] = -1
    for i in range(height):
        for j in range(width):
            if labels[i, j]:
                row = table[labels[i, j] - 1]
                row[AREA] += 1
                row[LEFT], row[RIGHT] = min(row[LEFT], j), max(row[RIGHT], j)
                row[TOP], row[BOTTOM] = min(row[TOP], i), max(row[BOTTOM], i)
                row[SUM_X] += j
                row[SUM_Y] += i
    return table
