"""The energy of a two-label field (equation 3), in integers.

Each pixel carries the difference between the object's singleton energy, ln g + k / 2, and the
background's constant one, in steps of 1 / STEPS nat. Whole numbers make sums exact: an optimiser
that never accepts a rise never shows one, and two solvers can be compared bit by bit.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.colour_model import ColourMixture, ColourModel, ColourTable
from naod.perception.colour_table import BINS, STEPS_MAX, cell_colours, filled, look_up, unpacked
from naod.perception.mixture import energies

STEPS = 256
"""Integer steps per nat."""

LIMIT = 1 << 20
"""Greatest absolute difference kept; no number of neighbours outweighs it."""


class Singletons:
    """Energy of one pixel under a colour model against a constant background.

    `light_std` widens the Gaussian along the line of colours that one surface has in more or less
    light, Y : U - 128 : V - 128 staying in proportion; so it does each of a mixture's. A colour
    table decides by itself wherever it has learnt something. A mixture is made a table, one value
    for each of its cells; `table` is (CELLS,) int16, empty for a Gaussian alone.
    """

    def __init__(
        self, model: ColourModel, background_energy: float, light_std: float = 0.0
    ) -> None:
        shades = light_std * (np.array(model.mean) - (0.0, 128.0, 128.0))
        covariance = np.array(model.covariance) + np.outer(shades, shades)
        log_g = 0.5 * (3.0 * math.log(2.0 * math.pi) + float(np.linalg.slogdet(covariance)[1]))
        self.offset = log_g - background_energy
        self.mean = np.array(model.mean, dtype=np.float32)
        # half the precision: x' (S^-1 / 2) x is k / 2
        self.half_precision = (0.5 * np.linalg.inv(covariance)).astype(np.float32)
        self.table: NDArray[np.int16] = np.zeros(0, dtype=np.int16)
        if isinstance(model, ColourTable):
            printed = np.empty((BINS * BINS, BINS), dtype=np.int32)
            self.differences(cell_colours(), printed)
            self.table = filled(unpacked(model.table), printed)
        if isinstance(model, ColourMixture):
            nats = energies(model, cell_colours().astype(np.float64), light_std)
            steps = np.rint((nats - background_energy) * STEPS)
            self.table = np.clip(steps, -STEPS_MAX, STEPS_MAX).astype(np.int16).ravel()

    def differences(self, yuv: NDArray[np.float32], out: NDArray[np.int32]) -> None:
        """Of each pixel of (h, w, 3) into (h, w) int32: negative where the object is likelier."""
        if self.table.size:
            look_up(yuv, self.table, out)
            return
        _differences(yuv, self.mean, self.half_precision, np.float32(self.offset), out)


@njit(cache=True, nogil=True)
def pixel_difference(
    y: np.float32,
    u: np.float32,
    v: np.float32,
    mean: NDArray[np.float32],
    half_precision: NDArray[np.float32],
    offset: np.float32,
) -> int:
    """Object energy less background energy of one colour, in steps."""
    a, b, c = y - mean[0], u - mean[1], v - mean[2]
    half_k = (
        a * (half_precision[0, 0] * a + np.float32(2.0) * half_precision[0, 1] * b)
        + b * (half_precision[1, 1] * b + np.float32(2.0) * half_precision[1, 2] * c)
        + c * (half_precision[2, 2] * c + np.float32(2.0) * half_precision[0, 2] * a)
    )
    scaled = (half_k + offset) * np.float32(STEPS)
    return int(min(max(scaled, np.float32(-LIMIT)), np.float32(LIMIT)))


@njit(cache=True, nogil=True)
def _differences(
    yuv: NDArray[np.float32],
    mean: NDArray[np.float32],
    half_precision: NDArray[np.float32],
    offset: np.float32,
    out: NDArray[np.int32],
) -> None:
    for i in range(yuv.shape[0]):
        for j in range(yuv.shape[1]):
            out[i, j] = pixel_difference(
                yuv[i, j, 0], yuv[i, j, 1], yuv[i, j, 2], mean, half_precision, offset
            )


@njit(cache=True, nogil=True)
def field_energy(differences: NDArray[np.int32], labels: NDArray[np.uint8], beta: int) -> int:
    """Steps above the all-background field: singletons of the object and beta per broken pair."""
    height, width = labels.shape
    total = 0
    for i in range(height):
        for j in range(width):
            label = labels[i, j]
            if label:
                total += differences[i, j]
            if j + 1 < width and labels[i, j + 1] != label:
                total += beta
            if i + 1 < height and labels[i + 1, j] != label:
                total += beta
    return total
