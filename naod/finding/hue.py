"""Whether a region has the object's hue and tone.

More or less light leaves both alone, and grey surroundings that blur mixes in leave the hue; what
is nearly of the object's colour mostly differs in one of them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.colour_model import STD_FLOOR, ColourModel, ColourTable, Triple
from naod.perception.colour_table import UNSEEN, cells_of, unpacked
from naod.perception.energy import STEPS

CLIP = 6.0
"""Nat: one pixel says no more than this for or against, its colour model may be wrong."""

GRID = 8
"""Places along each side of a box at which the picture is looked at."""

MIDDLE_SHARE = 0.5
"""Of the box's sides: blur mixes the surroundings into the rest."""

HUE_STD = 0.035
"""Rad by which an object's hue differs from room to room: light has a colour, too."""

LEVELS_STD = 1.5
"""Of the mean colour, 8-bit levels: what little colour there is says little of its hue."""

TONE_STD = 0.1
"""Of the logarithm of colour per brightness, from room to room."""

PEAK_MIN = 3.0
"""Nat: a model that is less sure of the object's own colour tells little."""

Own = tuple[float, float, float, float, float]
"""Y, U - 128 and V - 128 of the object, variance of its own hue in rad squared, and that of the
logarithm of its colour per brightness."""


@dataclass(frozen=True, slots=True)
class Colours:
    """The picture that was segmented, (H, W, 2) uint8 YUYV, and what the object's colour is."""

    yuyv: NDArray[np.uint8]
    model: ColourModel

    @property
    def own(self) -> Own:
        """An object of many colours has hardly a hue: its variance is large."""
        return _own(self.model.mean, self.model.covariance)

    @property
    def peak(self) -> float:
        """Nat by which a pixel of the object's own colour is likelier the object."""
        if not isinstance(self.model, ColourTable):
            return CLIP
        return min(max(_peak(self.model.table, self.model.mean), PEAK_MIN), CLIP)

    @property
    def picture(self) -> NDArray[np.uint8]:
        """Read-only, so that kernels are compiled once for whatever a camera gives."""
        raw: NDArray[np.uint8] = np.ascontiguousarray(self.yuyv).view()
        raw.flags.writeable = False
        return raw


@lru_cache(maxsize=8)
def _own(mean: Triple, covariance: tuple[Triple, Triple, Triple]) -> Own:
    """Of a model; asked for several times a picture."""
    y, u, v = mean[0], mean[1] - 128.0, mean[2] - 128.0
    length2 = max(u * u + v * v, 1.0)
    (yy, yu, yv), (_, uu, uv), (_, _, vv) = covariance
    # noise of single pixels is no other colour
    noise = STD_FLOOR**2
    across = (v * v * uu - 2.0 * u * v * uv + u * u * vv) / length2
    outwards = (u * u * uu + 2.0 * u * v * uv + v * v * vv) / length2
    both = (u * yu + v * yv) / length2
    bright = max(y, 1.0)
    tone = max(outwards - noise, 0.0) / length2 + max(yy - noise, 0.0) / bright**2
    tone = max(tone - 2.0 * both / bright, 0.0)
    return y, u, v, max(across - noise, 0.0) / length2, tone


@lru_cache(maxsize=8)
def _peak(table: str, mean: Triple) -> float:
    """The table's value for a colour; unpacking costs a millisecond, once for each model."""
    steps = unpacked(table)[cells_of(np.array(mean, dtype=np.float32))]
    return CLIP if steps == UNSEEN else -float(steps) / STEPS


NO_PICTURE: NDArray[np.uint8] = np.zeros((0, 0, 2), dtype=np.uint8)
NO_PICTURE.flags.writeable = False
NO_OWN: Own = (0.0, 0.0, 0.0, 0.0, 0.0)


@njit(cache=True, nogil=True)
def block_of(picture: NDArray[np.uint8], height: int) -> int:
    """Side of the blocks of which `height` rows make up a picture; the last may be smaller."""
    return -(-picture.shape[0] // height)


@njit(cache=True, nogil=True)
def add_block(
    picture: NDArray[np.uint8], i: int, j: int, block: int, every: int, sums: NDArray[np.float64]
) -> None:
    """Add Y, U, V and how many of the block behind a mask pixel, of one row in `every`."""
    first, rows, columns = j * block // 2 * 2, picture.shape[0], picture.shape[1]
    for row in range(i * block, min((i + 1) * block, rows), every):
        for column in range(first, min(max((j + 1) * block, first + 1), columns), 2):
            sums[0] += picture[row, column, 0]
            sums[1] += picture[row, column, 1]
            sums[2] += picture[row, column + 1, 1]
            sums[3] += 1.0


@njit(cache=True, nogil=True)
def _middle_colour(
    picture: NDArray[np.uint8],
    labels: NDArray[np.int32],
    wanted: NDArray[np.bool_],
    box: NDArray[np.float64],
    sums: NDArray[np.float64],
) -> None:
    height, width = labels.shape
    block = block_of(picture, height)
    for a in range(GRID):
        along = ((a + 0.5) / GRID - 0.5) * MIDDLE_SHARE * box[5]
        for b in range(GRID):
            across = ((b + 0.5) / GRID - 0.5) * MIDDLE_SHARE * box[4]
            j = round(box[0] + along * box[2] + across * box[3])
            i = round(box[1] + along * box[3] - across * box[2])
            if 0 <= i < height and 0 <= j < width and wanted[labels[i, j]]:
                # every other row will do
                add_block(picture, i, j, block, 2, sums)


@njit(cache=True, nogil=True)
def look_at_middle(
    picture: NDArray[np.uint8],
    labels: NDArray[np.int32],
    wanted: NDArray[np.bool_],
    box: NDArray[np.float64],
    own: Own,
) -> tuple[float, float]:
    """How far hue and tone in the middle of a box (6,) are from the object's, in tolerances.

    picture: (H, W, 2) YUYV, labels (h, w) one for each of its blocks; only what is `wanted` counts.
    Hue either way; tone, the logarithm of colour per brightness, positive where it is more than
    the object's. 0 where nothing of it is in the middle.
    """
    sums = np.zeros(4)
    _middle_colour(picture, labels, wanted, box, sums)
    if sums[3] == 0.0:
        return 0.0, 0.0
    bright = max(sums[0] / sums[3], 1.0)
    u, v = sums[1] / sums[3] - 128.0, sums[2] / sums[3] - 128.0
    length2, own2 = max(u * u + v * v, 1.0), max(own[1] ** 2 + own[2] ** 2, 1.0)
    gap = math.atan2(own[1] * v - own[2] * u, own[1] * u + own[2] * v)
    unsure = LEVELS_STD**2 / min(length2, own2)
    tone = 0.5 * math.log(length2 / own2) - math.log(bright / max(own[0], 1.0))
    return (
        abs(gap) / math.sqrt(own[3] + HUE_STD**2 + unsure),
        tone / math.sqrt(own[4] + TONE_STD**2 + unsure),
    )
