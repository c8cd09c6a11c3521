"""Bounds between which every minimum of a two-label Potts energy lies.

The energy is submodular. From all-background, a cell that lowers the energy by joining the object
does so next to any greater object too; from all-object, a cell that does not raise the energy by
leaving may leave any smaller object. Both movements, each one-way, enclose the least minimum, and
where they meet its label is known. They run together: an open cell is background in one and object
in the other. All rows are asked at once a few times; cells that stay open are then asked again only
when a neighbour has been decided.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.optimum_field import (
    ALWAYS,
    BACKGROUND,
    BORDER,
    CANDIDATES,
    CELLS_A_WORD,
    NEVER,
    NOWHERE,
    OBJECT,
    OPEN,
    UNDECIDED,
    Field,
    neighbourhood,
    sides,
)

_OBJECT_BITS = np.uint64(0x0202020202020202)
_ANY_BITS = np.uint64(0x2222222222222222)
_DIGIT = np.uint64(4)
_NONE = np.uint64(0)

ROUNDS = 8
"""Of questions to all rows at once; an even number. The cells that would need more are few."""


@njit(cache=True, nogil=True)
def _open(field: Field) -> None:
    """Codes of all cells from their needs, and which rows have more than background."""
    # one loop over all rows: a row is too short for wide vectors
    codes, needs = field.codes, field.needs.reshape(-1)
    for k in range(codes.size):
        need = needs[k]
        open_bit = np.uint8(need < np.uint8(NEVER)) << np.uint8(5)
        object_bit = np.uint8(need == np.uint8(ALWAYS)) << np.uint8(1)
        border = np.uint8(need == np.uint8(NOWHERE)) * np.uint8(BORDER)
        codes[k] = np.uint8(open_bit | object_bit | border)
    for row in range(field.hot.size):
        words, seen = field.words[row], _NONE
        for k in range(words.size):
            seen |= words[k]
        field.hot[row] = np.uint8(seen & _ANY_BITS != _NONE)


@njit(cache=True, nogil=True)
def _ask(
    codes: NDArray[np.uint8],
    needs: NDArray[np.uint8],
    out: NDArray[np.uint8],
    first: int,
    last: int,
    pitch: int,
) -> None:
    """Decide what can be decided between two cells from the codes as they are, into `out`."""
    left, right = codes[first - 1 : last - 1], codes[first + 1 : last + 1]
    up, down = codes[first - pitch : last - pitch], codes[first + pitch : last + pitch]
    own, need, new = codes[first:last], needs[first:last], out[first:last]
    for k in range(own.size):
        near = np.uint8(np.uint8(left[k] + right[k]) + np.uint8(up[k] + down[k]))
        is_open = np.uint8(own[k] == np.uint8(OPEN))
        leaves = np.uint8(np.uint8(near >> np.uint8(4)) < need[k]) & is_open
        joins = np.uint8(np.uint8(near & np.uint8(15)) >= need[k]) & is_open
        # an open cell that joins is not one that leaves: its lower sum is never above its upper one
        new[k] = np.uint8(own[k] + np.uint8(joins << np.uint8(1)) - np.uint8(leaves << np.uint8(5)))


@njit(cache=True, nogil=True)
def _ask_all(field: Field) -> None:
    """ROUNDS of questions to all rows from the first to the last that are not background."""
    top, bottom = 0, field.hot.size - 1
    while top < bottom and field.hot[top] == 0:
        top += 1
    while bottom > top and field.hot[bottom] == 0:
        bottom -= 1
    if field.hot[top] == 0:
        return
    pitch = field.rows.shape[1]
    first, last = top * pitch, (bottom + 1) * pitch
    field.asked[first - pitch : first] = field.codes[first - pitch : first]
    field.asked[last : last + pitch] = field.codes[last : last + pitch]
    needs = field.needs.reshape(-1)
    for _ in range(ROUNDS // 2):
        _ask(field.codes, needs, field.asked, first, last, pitch)
        _ask(field.asked, needs, field.codes, first, last, pitch)


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
def _verdict(field: Field, needs: NDArray[np.uint8], cell: np.uint64) -> np.uint8:
    """OBJECT or BACKGROUND where both bounds agree on the cell, given its neighbours, else OPEN."""
    near, need = neighbourhood(field, cell), needs[cell]
    code = np.uint8(BACKGROUND) if (near >> 4) < need else np.uint8(OPEN)
    return np.uint8(OBJECT) if (near & 15) >= need else code


@njit(cache=True, nogil=True)
def _spread(field: Field, needs: NDArray[np.uint8], pending: int) -> None:
    """Ask again around every pending cell until nothing more follows."""
    while pending > 0:
        pending -= 1
        centre = np.uint64(field.pending[pending])
        for step in sides(field):
            cell = centre + step
            if field.codes[cell] == OPEN:
                code = _verdict(field, needs, cell)
                field.codes[cell] = code
                field.pending[pending] = cell
                pending += code != OPEN


@njit(cache=True, nogil=True)
def _decide(field: Field, candidates: int) -> int:
    """Both movements over the candidates; keeps those still open and returns their number."""
    needs = field.needs.reshape(-1)
    pending = left = 0
    for k in range(candidates):
        cell = np.uint64(field.candidates[k])
        code = _verdict(field, needs, cell)
        field.codes[cell] = code
        field.pending[pending] = field.candidates[left] = cell
        pending += code != OPEN
        left += code == OPEN
    _spread(field, needs, pending)
    candidates, left = left, 0
    for k in range(candidates):
        cell = np.uint64(field.candidates[k])
        field.candidates[left] = cell
        left += field.codes[cell] == OPEN
    return left


@njit(cache=True, nogil=True)
def bracket(field: Field, differences: NDArray[np.int32]) -> int:
    """Decide codes of all cells from their needs; open ones are the first of the candidates.

    `differences` is (h, w). Returns the number of cells still open.
    """
    _open(field)
    _ask_all(field)
    count = 0
    for i in range(differences.shape[0]):
        if field.hot[i + 1]:
            count = _collect(field, differences[i], i + 1, count)
    left = _decide(field, count)
    field.counts[CANDIDATES] = count
    field.counts[UNDECIDED] = left
    return left
