"""Bounds between which every minimum of a two-label Potts energy lies.

The energy is submodular. From all-background, a cell that lowers the energy by joining the object
does so next to any greater object too; from all-object, a cell that does not raise the energy by
leaving may leave any smaller object. Both movements, each one-way, enclose the least minimum, and
where they meet its label is known. They run together: an open cell is background in one and object
in the other.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.optimum_field import (
    BACKGROUND,
    CANDIDATES,
    CELLS_A_WORD,
    OBJECT,
    OPEN,
    UNDECIDED,
    Field,
    neighbourhood,
    sides,
)

_OBJECT_BITS = np.uint64(0x0202020202020202)
_DIGIT = np.uint64(4)
_NONE = np.uint64(0)


@njit(cache=True, nogil=True)
def _classify(differences: NDArray[np.int32], limit: np.int32, codes: NDArray[np.uint8]) -> None:
    """One row: a difference that four neighbours cannot outweigh decides by itself."""
    for j in range(differences.size):
        difference = differences[j]
        code = np.uint8(OPEN) if difference < limit else np.uint8(BACKGROUND)
        codes[j] = np.uint8(OBJECT) if difference < -limit else code


@njit(cache=True, nogil=True)
def _collect(field: Field, differences: NDArray[np.int32], row: int, count: int) -> int:
    """Append the open cells of a padded row to the candidates; their number afterwards."""
    codes, words = field.rows[row], field.words[row]
    start = row * codes.size
    for k in range(words.size):
        word = words[k]
        if (word >> _DIGIT) & ~word & _OBJECT_BITS == _NONE:
            continue
        for j in range(k * CELLS_A_WORD, (k + 1) * CELLS_A_WORD):
            if codes[j] == OPEN:
                field.candidates[count] = start + j
                field.differences[start + j] = differences[j]
                count += 1
    return count


@njit(cache=True, nogil=True)
def _verdict(field: Field, beta: int, cell: np.uint64) -> np.uint8:
    """OBJECT or BACKGROUND where both bounds agree on the cell, given its neighbours, else OPEN."""
    near = neighbourhood(field, cell)
    joins = field.differences[cell] + beta * (4 - (near & 15)) < 0
    leaves = field.differences[cell] + beta * (4 - (near >> 4)) >= 0
    code = np.uint8(BACKGROUND) if leaves else np.uint8(OPEN)
    return np.uint8(OBJECT) if joins else code


@njit(cache=True, nogil=True)
def _spread(field: Field, beta: int, pending: int) -> None:
    """Ask again around every pending cell until nothing more follows."""
    while pending > 0:
        pending -= 1
        centre = np.uint64(field.pending[pending])
        for step in sides(field):
            cell = centre + step
            if field.codes[cell] == OPEN:
                code = _verdict(field, beta, cell)
                field.codes[cell] = code
                field.pending[pending] = cell
                pending += code != OPEN


@njit(cache=True, nogil=True)
def _decide(field: Field, beta: int, candidates: int) -> int:
    """Both movements over the candidates; keeps those still open and returns their number."""
    pending = left = 0
    for k in range(candidates):
        cell = np.uint64(field.candidates[k])
        code = _verdict(field, beta, cell)
        field.codes[cell] = code
        field.pending[pending] = field.candidates[left] = cell
        pending += code != OPEN
        left += code == OPEN
    _spread(field, beta, pending)
    candidates, left = left, 0
    for k in range(candidates):
        cell = np.uint64(field.candidates[k])
        field.candidates[left] = cell
        left += field.codes[cell] == OPEN
    return left


@njit(cache=True, nogil=True)
def bracket(field: Field, differences: NDArray[np.int32], beta: int) -> int:
    """Codes of all cells from (h, w) differences; open ones are the first of the candidates.

    Returns their number.
    """
    height, width = differences.shape
    count = 0
    for i in range(height):
        _classify(differences[i], np.int32(4 * beta), field.rows[i + 1, :width])
        count = _collect(field, differences[i], i + 1, count)
    left = _decide(field, beta, count)
    field.counts[CANDIDATES] = count
    field.counts[UNDECIDED] = left
    return left
