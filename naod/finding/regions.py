"""Regions of a segmentation, and their cores: where much speaks for the object, not just a little.

A thing that touches the object and has nearly its colour makes one region with it. The object's
pixels are the surer ones, so a stricter level tells them apart.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.blob import evidence
from naod.perception.components import AREA, components, paint
from naod.perception.energy import STEPS
from naod.perception.runs import EVIDENCE, Runs
from naod.perception.segmenter import Segmentation
from naod.perception.sight import Sight

SURE_STEPS = 3 * STEPS
"""What a pixel says where nothing but its label is known."""

CORE_SHARE = 0.6
"""Of what a region's surest pixel says; what says less is not of its core."""

PEAK_MAX = 6 * STEPS
CORE_OF_PIXELS = 24
"""Smaller regions have no core worth looking at."""


@dataclass(frozen=True, slots=True)
class Regions:
    """`labels` (h, w) int32, 0 outside; `table` (n, 7 or 8) int64, row k - 1 for label k.

    Columns as `components` has them. `told` (n,) float64: steps by which the pixels of each are
    likelier object. `differences` (h, w) int32: of each pixel, object's less background's.
    """

    labels: NDArray[np.int32]
    table: NDArray[np.int64]
    told: NDArray[np.float64]
    differences: NDArray[np.int32]


def regions_of(segmentation: Segmentation) -> Regions:
    """Those of its mask; a segmenter has looked for them already."""
    sight = segmentation.sight
    if sight is not None:
        return _seen(sight)
    differences = segmentation.differences
    if differences is None:
        differences = np.where(segmentation.mask > 0, np.int32(-SURE_STEPS), np.int32(SURE_STEPS))
    labels, table = components(segmentation.mask)
    return Regions(labels, table, evidence(labels, differences, len(table)), differences)


def cores_of(regions: Regions) -> Regions:
    """Connected parts of regions at the stricter level; no pixel is in a core but not in them."""
    mask = _core_mask(regions.labels, regions.table[:, AREA], regions.differences)
    labels, table = components(mask)
    told = evidence(labels, regions.differences, len(table))
    return Regions(labels, table, told, regions.differences)


def _seen(sight: Sight) -> Regions:
    labels = np.zeros(sight.mask.shape, dtype=np.int32)
    _paint(sight.runs, sight.run_count, labels)
    # the segmenter's memory is used again, what is made of a picture stays
    table = sight.runs.table[1 : sight.regions + 1].copy()
    return Regions(labels, table, table[:, EVIDENCE].astype(np.float64), sight.differences)


@njit(cache=True, nogil=True)
def _paint(runs: Runs, count: int, labels: NDArray[np.int32]) -> None:
    paint(runs, count, labels)


@njit(cache=True, nogil=True)
def _core_mask(
    labels: NDArray[np.int32], areas: NDArray[np.int64], differences: NDArray[np.int32]
) -> NDArray[np.uint8]:
    height, width = labels.shape
    least = np.zeros(areas.size + 1, dtype=np.int32)
    for i in range(height):
        for j in range(width):
            if labels[i, j]:
                least[labels[i, j]] = min(least[labels[i, j]], differences[i, j])
    for k in range(areas.size):
        level = CORE_SHARE * min(-least[k + 1], PEAK_MAX)
        least[k + 1] = -np.int32(level) if areas[k] >= CORE_OF_PIXELS else -(1 << 30)
    mask = np.zeros((height, width), dtype=np.uint8)
    for i in range(height):
        for j in range(width):
            if labels[i, j] and differences[i, j] < least[labels[i, j]]:
                mask[i, j] = 1
    return mask
