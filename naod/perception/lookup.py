"""A colour model compiled into one table: what every colour that a picture can have costs.

Whatever the kind of model, a pixel is then one look into memory. An entry holds the difference of
energies in steps and, in its lowest bits, the pixel's need: how many of the neighbours' votes
make it object (see `naod.perception.optimum_field`), which beta and the difference decide.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.energy import LIMIT, Singletons
from naod.perception.optimum_field import needs_of
from naod.perception.quantising import C_BITS, CELLS, Y_BITS

NEED_BITS = 4
NEED_MASK = (1 << NEED_BITS) - 1


@cache
def cell_colours() -> NDArray[np.float32]:
    """The colour in the middle of each cell, (cells of Y and U, cells of V, 3)."""
    axes = []
    for bits in (Y_BITS, C_BITS, C_BITS):
        levels = 256 >> bits
        axes.append((np.arange(1 << bits, dtype=np.float32) + np.float32(0.5)) * levels)
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    return np.ascontiguousarray(grid.reshape(-1, 1 << C_BITS, 3))


@njit(cache=True, nogil=True)
def _pack(
    differences: NDArray[np.int32],
    beta: int,
    needs: NDArray[np.uint8],
    entries: NDArray[np.int32],
) -> None:
    for k in range(entries.size):
        differences[k] = min(max(differences[k], np.int32(-LIMIT)), np.int32(LIMIT))
    needs_of(differences, np.int32(beta), needs)
    for k in range(entries.size):
        entries[k] = (differences[k] << NEED_BITS) | np.int32(needs[k])


class Lookup:
    """Entries (CELLS,) int32 for one model and one beta, in memory taken at the start."""

    def __init__(self, singletons: Singletons, beta: int) -> None:
        self.entries = np.empty(CELLS, dtype=np.int32)
        self._differences = np.empty(cell_colours().shape[:2], dtype=np.int32)
        self._needs = np.empty(CELLS, dtype=np.uint8)
        self.rebuild(singletons, beta)

    def rebuild(self, singletons: Singletons, beta: int) -> None:
        """Take another model, or another beta in steps; about a millisecond."""
        singletons.differences(cell_colours(), self._differences)
        _pack(self._differences.reshape(-1), beta, self._needs, self.entries)
