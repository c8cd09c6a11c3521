"""A mask at the picture's own size, its boundary decided again pixel by pixel."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.colour_table import looked_up
from naod.perception.energy import pixel_difference
from naod.perception.icm import best_label
from naod.perception.segmenter import Segmentation, Segmenter

SWEEPS = 10


@njit(cache=True, nogil=True)
def _spread(
    small: NDArray[np.uint8], block: int, labels: NDArray[np.uint8], band: NDArray[np.bool_]
) -> None:
    """Labels of the blocks, and the band: blocks with another label among eight neighbours."""
    rows, columns = small.shape
    for i in range(rows):
        for j in range(columns):
            mixed = False
            for a in range(max(i - 1, 0), min(i + 2, rows)):
                for b in range(max(j - 1, 0), min(j + 2, columns)):
                    mixed |= small[a, b] != small[i, j]
            for y in range(i * block, min((i + 1) * block, labels.shape[0])):
                for x in range(j * block, min((j + 1) * block, labels.shape[1])):
                    labels[y, x] = small[i, j]
                    band[y, x] = mixed


@njit(cache=True, nogil=True)
def _difference_in_band(
    yuyv: NDArray[np.uint8],
    band: NDArray[np.bool_],
    mean: NDArray[np.float32],
    half_precision: NDArray[np.float32],
    offset: np.float32,
    table: NDArray[np.int16],
    out: NDArray[np.int32],
) -> None:
    for y in range(band.shape[0]):
        for x in range(band.shape[1]):
            if band[y, x]:
                left = x - x % 2
                luma, u = np.float32(yuyv[y, x, 0]), np.float32(yuyv[y, left, 1])
                v = np.float32(yuyv[y, left + 1, 1])
                if table.size:
                    out[y, x] = looked_up(luma, u, v, table)
                else:
                    out[y, x] = pixel_difference(luma, u, v, mean, half_precision, offset)


@njit(cache=True, nogil=True)
def _descend_in_band(
    differences: NDArray[np.int32],
    band: NDArray[np.bool_],
    labels: NDArray[np.uint8],
    beta: int,
    sweeps: int,
) -> None:
    for _ in range(sweeps):
        changed = False
        for y in range(band.shape[0]):
            for x in range(band.shape[1]):
                if band[y, x]:
                    label = best_label(differences, labels, beta, y, x)[0]
                    changed |= label != labels[y, x]
                    labels[y, x] = label
        if not changed:
            return


def full_mask(
    segmenter: Segmenter, segmentation: Segmentation, yuyv: NDArray[np.uint8]
) -> NDArray[np.uint8]:
    """(H, W) uint8, 1 = object: the same energy at full resolution, brought down near boundaries.

    Away from them the reduced labels stand.
    """
    width, height = segmentation.size
    labels = np.empty((height, width), dtype=np.uint8)
    band = np.empty((height, width), dtype=np.bool_)
    block = round(segmentation.scale)
    _spread(segmentation.mask, block, labels, band)
    if block == 1:
        return labels
    differences = np.zeros((height, width), dtype=np.int32)
    s = segmenter.singletons
    _difference_in_band(
        np.ascontiguousarray(yuyv),
        band,
        s.mean,
        s.half_precision,
        np.float32(s.offset),
        s.table,
        differences,
    )
    _descend_in_band(differences, band, labels, segmenter.beta_steps, SWEEPS)
    return labels
