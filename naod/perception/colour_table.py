"""The object's colour as a table: how much likelier object than background, for each colour.

Y, U and V are quantised to BINS levels each. A cell holds the background's log-likelihood less the
object's, as `naod.perception.energy` counts it, or UNSEEN where nothing was learnt.
"""

from __future__ import annotations

import base64
import binascii
import zlib

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.errors import InputError

BINS = 32
CELLS = BINS**3
LEVELS_PER_BIN = 256 // BINS
UNSEEN = -32768
STEPS_MAX = 32767

Cells = NDArray[np.int16]


def packed(table: Cells, level: int = 6) -> str:
    """The text in MODEL.toml: little-endian int16, Y slowest and V fastest, zlib, base64."""
    return base64.b64encode(zlib.compress(table.astype("<i2").tobytes(), level)).decode()


def unpacked(text: str) -> Cells:
    """(CELLS,) int16. Raises InputError that says what is wrong with the text."""
    try:
        # never more than a table, whatever the text claims
        data = zlib.decompressobj().decompress(base64.b64decode(text, validate=True), 2 * CELLS + 1)
    except (binascii.Error, ValueError, zlib.error) as error:
        raise InputError(f"table: not a compressed table: {error}") from None
    if len(data) != 2 * CELLS:
        raise InputError(f"table: holds {len(data)} bytes or more, not {2 * CELLS}")
    return np.frombuffer(data, dtype="<i2").astype(np.int16)


def smoothed(counts: NDArray[np.float64], std_bins: float = 0.7) -> NDArray[np.float64]:
    """Counts (CELLS,) shared out among the cells around by a Gaussian; none are lost."""
    offsets = np.arange(BINS)[:, None] - np.arange(BINS)
    kernel = np.exp(-0.5 * (offsets / std_bins) ** 2)
    kernel /= kernel.sum(axis=0)
    cube = counts.reshape(BINS, BINS * BINS)
    for _ in range(3):
        # each time the axis that was first goes last
        cube = (kernel @ cube).reshape(BINS, BINS * BINS).T.reshape(BINS, BINS * BINS)
    return cube.ravel()


def cells_of(yuv: NDArray[np.float32]) -> NDArray[np.int64]:
    """Places in the table of colours (..., 3), clipped to 8-bit levels."""
    places = np.clip(yuv / LEVELS_PER_BIN, 0, BINS - 1).astype(np.int64)
    return (places[..., 0] * BINS + places[..., 1]) * BINS + places[..., 2]


def cell_colours() -> NDArray[np.float32]:
    """The colour in the middle of each cell, (BINS * BINS, BINS, 3)."""
    middles = (np.arange(BINS, dtype=np.float32) + np.float32(0.5)) * LEVELS_PER_BIN
    grid = np.stack(np.meshgrid(middles, middles, middles, indexing="ij"), axis=-1)
    return np.ascontiguousarray(grid.reshape(BINS * BINS, BINS, 3))


def filled(table: Cells, fallback: NDArray[np.int32]) -> Cells:
    """The table with `fallback`, as many steps, where nothing was learnt."""
    other = np.clip(fallback.ravel(), -STEPS_MAX, STEPS_MAX).astype(np.int16)
    return np.where(table == UNSEEN, other, table)


@njit(cache=True, nogil=True)
def looked_up(y: np.float32, u: np.float32, v: np.float32, table: NDArray[np.int16]) -> int:
    """The table's steps for a colour of 8-bit levels, 0 to 255."""
    row = int(y) // LEVELS_PER_BIN * BINS + int(u) // LEVELS_PER_BIN
    return int(table[row * BINS + int(v) // LEVELS_PER_BIN])


@njit(cache=True, nogil=True)
def look_up(yuv: NDArray[np.float32], table: NDArray[np.int16], out: NDArray[np.int32]) -> None:
    """Of each pixel of (h, w, 3) into (h, w) int32."""
    for i in range(yuv.shape[0]):
        for j in range(yuv.shape[1]):
            out[i, j] = looked_up(yuv[i, j, 0], yuv[i, j, 1], yuv[i, j, 2], table)
