"""A colour model compiled into tables: what every colour that a picture can have costs.

Whatever the kind of model, a pixel is then one look into memory. That is for its votes (see
`naod.perception.optimum_field`), which beta and the difference decide, in a table small enough for
the processor's caches; few pixels need the difference of energies itself.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.energy import LIMIT, Singletons
from naod.perception.optimum_field import votes_of
from naod.perception.quantising import C_BITS, CELLS, Y_BITS


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
def _limit(values: NDArray[np.int32], beta: int, votes: NDArray[np.uint8]) -> None:
    for k in range(values.size):
        values[k] = min(max(values[k], np.int32(-LIMIT)), np.int32(LIMIT))
    votes_of(values, np.int32(beta), votes)


class Lookup:
    """Of each of CELLS colours, for one model and one beta, in memory taken at the start.

    `values` (CELLS,) int32: the difference of energies in steps. `votes` (CELLS,) uint8.
    """

    def __init__(self, singletons: Singletons, beta: int) -> None:
        self.values = np.empty(CELLS, dtype=np.int32)
        self.votes = np.empty(CELLS, dtype=np.uint8)
        self.rebuild(singletons, beta)

    def rebuild(self, singletons: Singletons, beta: int) -> None:
        """Take another model, or another beta in steps; about a millisecond."""
        colours = cell_colours()
        singletons.differences(colours, self.values.reshape(colours.shape[:2]))
        _limit(self.values, beta, self.votes)
