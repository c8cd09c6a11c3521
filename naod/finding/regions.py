"""Regions of a segmentation, and their cores: where much speaks for the object, not just a little.

A thing that touches the object and has nearly its colour makes one region with it. The object's
pixels are the surer ones, so a stricter level tells them apart.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.finding.groups import NO_COLOURS
from naod.perception.blob import evidence
from naod.perception.components import AREA, BOTTOM, LEFT, RIGHT, TOP, components
from naod.perception.energy import STEPS
from naod.perception.runs import EVIDENCE
from naod.perception.segmenter import Segmentation
from naod.perception.sight import Sight

SURE_STEPS = 3 * STEPS
"""What a pixel says where nothing but its label is known."""

CORE_SHARE = 0.6
"""Of what a region's surest pixel says; what says less is not of its core."""

PEAK_MAX = 6 * STEPS
CORE, RIM = np.uint8(1), np.uint8(2)
CORE_OF_PIXELS = 24
"""Smaller regions have no core worth looking at."""


@dataclass(frozen=True, slots=True)
class Regions:
    """`labels` (h, w) int32, 0 outside; `table` (n, 7 or 8) int64, row k - 1 for label k.

    Columns as `components` has them. `told` (n,) float64: steps by which the pixels of each are
    likelier object. `differences` (h, w) int32: of each pixel, object's less background's.
    `colours` (n, 3): mean Y, U and V where that must be alike in what belongs together, else
    NO_COLOURS. `around_max`: nat that their surroundings count at most.
    """

    labels: NDArray[np.int32]
    table: NDArray[np.int64]
    told: NDArray[np.float64]
    differences: NDArray[np.int32]
    colours: NDArray[np.float64] = field(default_factory=lambda: NO_COLOURS)
    around_max: float = math.inf


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
    """Connected parts of regions at the stricter level; no pixel is in a core but not in them.

    Blur leaves a rim that is less sure: where a core comes near the end of its region, it ends
    there.
    """
    mask = _core_mask(regions.labels, regions.table, regions.differences)
    labels, table = components(mask)
    told = evidence(labels, regions.differences, len(table))
    return Regions(labels, table, told, regions.differences)


def _seen(sight: Sight) -> Regions:
    labels, table = sight.labelled()
    return Regions(labels, table, table[:, EVIDENCE].astype(np.float64), sight.differences)


@njit(cache=True, nogil=True)
def _core_mask(
    labels: NDArray[np.int32], table: NDArray[np.int64], differences: NDArray[np.int32]
) -> NDArray[np.uint8]:
    mask = np.zeros(labels.shape, dtype=np.uint8)
    for k in range(len(table)):
        _mark_core(labels, table[k], np.int32(k + 1), differences, mask)
        _mark_rim(labels, table[k], np.int32(k + 1), mask)
    return mask


@njit(cache=True, nogil=True)
def _mark_core(
    labels: NDArray[np.int32],
    region: NDArray[np.int64],
    label: np.int32,
    differences: NDArray[np.int32],
    mask: NDArray[np.uint8],
) -> None:
    """Mark as CORE what is surer than the level; all of a small region."""
    rows, columns = (region[TOP], region[BOTTOM] + 1), (region[LEFT], region[RIGHT] + 1)
    level = 1 << 30
    if region[AREA] >= CORE_OF_PIXELS:
        surest = 0
        for i in range(rows[0], rows[1]):
            for j in range(columns[0], columns[1]):
                if labels[i, j] == label:
                    surest = max(surest, -differences[i, j])
        level = -int(CORE_SHARE * min(surest, PEAK_MAX))
    for i in range(rows[0], rows[1]):
        for j in range(columns[0], columns[1]):
            if labels[i, j] == label and differences[i, j] < level:
                mask[i, j] = CORE


@njit(cache=True, nogil=True)
def _mark_rim(
    labels: NDArray[np.int32],
    region: NDArray[np.int64],
    label: np.int32,
    mask: NDArray[np.uint8],
) -> None:
    """Mark as RIM the pixels beside a core that are the last ones of their region."""
    height, width = labels.shape
    for i in range(region[TOP], region[BOTTOM] + 1):
        for j in range(region[LEFT], region[RIGHT] + 1):
            if labels[i, j] != label or mask[i, j]:
                continue
            beside = last = False
            for y in range(max(i - 1, 0), min(i + 2, height)):
                for x in range(max(j - 1, 0), min(j + 2, width)):
                    beside |= mask[y, x] == CORE
                    last |= labels[y, x] == 0
            if beside and last:
                mask[i, j] = RIM
