"""Bounds between which every minimum of a two-label Potts energy lies.

The energy is submodular. From all-background, a cell that lowers the energy by joining the object
does so next to any greater object too; from all-object, a cell that does not raise the energy by
leaving may leave any smaller object. Both movements, each one-way, enclose the least minimum, and
where they meet its label is known. Sixty-four cells move at once: what a cell does depends only on
how many of its neighbours are object, and those counts are a few operations on bits.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.bits import EXPANDED, WORD, ones, trailing_zeros, transpose, words_of
from naod.perception.optimum_field import (
    CANDIDATES,
    CELLS_A_WORD,
    ENOUGH,
    HALF,
    OBJECT,
    OPEN,
    PLANES,
    UNDECIDED,
    Field,
    pitch_of,
)

Bits = NDArray[np.uint64]

SWEEPS_MAX = 16
"""Down and up over the rows that can still change; what moves further is left to the cut."""

TURNS_MAX = 6
"""Of a row before the next one's turn; each moves a bound by one column."""

_U0, _U1, _U8, _U63 = (np.uint64(n) for n in (0, 1, 8, 63))
_BYTE = np.uint64(0xFF)
_OPEN, _OBJECT = np.uint64(OPEN), np.uint64(OBJECT)


@njit(cache=True, nogil=True)
def _beside_border(votes: np.uint8, missing: int) -> np.uint8:
    """Votes of a pixel that has `missing` neighbours less: each of those is half a vote."""
    if votes & ENOUGH == 0:
        # four were not enough
        return np.uint8(0)
    shift = (missing + (1 if votes & HALF else 0)) // 2
    return np.uint8((votes & ENOUGH) >> shift | (ENOUGH << (PLANES - shift)) & ENOUGH)


@njit(cache=True, nogil=True)
def take_row(
    votes: NDArray[np.uint8],
    eights: Bits,
    planes: NDArray[np.uint8],
    row: int,
    height: int,
    width: int,
) -> None:
    """Planes of one row of the picture from its pixels' votes, which are used up.

    votes, eights, planes: of a field, which as a whole would be much to hand over for every row.
    """
    above_below = (row == 0) + (row == height - 1)
    if above_below:
        for j in range(width):
            votes[j] = _beside_border(votes[j], above_below + (j == 0) + (j == width - 1))
    else:
        votes[0] = _beside_border(votes[0], 1 + (width == 1))
        if width > 1:
            votes[width - 1] = _beside_border(votes[width - 1], 1)
    count = -(-width // CELLS_A_WORD)
    # the last word may hold what another row left there
    votes[width : CELLS_A_WORD * count] = 0
    transpose(eights, count)
    first = (row + 1) * words_of(width) * CELLS_A_WORD
    for k in range(PLANES):
        plane, place = planes[k, first : first + count], np.uint64(8 * k)
        for n in range(count):
            plane[n] = np.uint8(eights[n] >> place)


@njit(cache=True, nogil=True)
def _start(field: Field, height: int, words: int) -> None:
    """Bounds from the pixels' own differences; CANDIDATES are counted."""
    least, most, planes = field.least, field.most, field.planes
    between = _U0
    for k in range(words, (height + 1) * words):
        low, high = planes[0, k], planes[PLANES - 1, k]
        least[k], most[k] = low, high
        between += ones(high & ~low)
    field.counts[CANDIDATES] = np.int64(between)


@njit(cache=True, nogil=True)
def _turn(planes: Bits, bound: Bits, row: int, words: int) -> bool:
    """Move one row of a bound by its neighbours as they are; whether anything moved."""
    moved = _U0
    for k in range(row * words, (row + 1) * words - 1):
        own = bound[k]
        left = own << _U1 | bound[k - 1] >> _U63
        right = own >> _U1 | bound[k + 1] << _U63
        up, down = bound[k - words], bound[k + words]
        either, both = left | right, left & right
        either_row, both_rows = up | down, up & down
        next_ = planes[0, k] | planes[1, k] & (either | either_row)
        next_ |= planes[2, k] & (both | both_rows | either & either_row)
        next_ |= planes[3, k] & (both & either_row | both_rows & either)
        next_ |= planes[4, k] & both & both_rows
        moved |= next_ ^ own
        bound[k] = next_
    return moved != _U0


@njit(cache=True, nogil=True)
def _settle(field: Field, bound: Bits, height: int, words: int) -> None:
    """Sweep down and up over the rows beside which something moved."""
    dirty, planes = field.dirty, field.planes
    for row in range(1, height + 1):
        open_ = _U0
        for k in range(row * words, (row + 1) * words):
            open_ |= planes[PLANES - 1, k]
        dirty[row] = np.uint8(open_ != _U0)
    for sweep in range(SWEEPS_MAX):
        moved_any = False
        for step in range(height):
            row = 1 + step if sweep % 2 == 0 else height - step
            if dirty[row] == 0:
                continue
            dirty[row] = 0
            turns = 0
            while turns < TURNS_MAX and _turn(planes, bound, row, words):
                turns += 1
            if turns:
                moved_any = True
                dirty[row - 1] = dirty[row + 1] = 1
                dirty[row] = np.uint8(turns == TURNS_MAX)
        if not moved_any:
            return


@njit(cache=True, nogil=True)
def _list_open(field: Field, values: NDArray[np.int32], places: NDArray[np.uint32]) -> int:
    """All cells between the bounds become candidates; how many there are."""
    height, width = places.shape
    words, pitch, count = words_of(width), np.uint64(pitch_of(width)), 0
    for i in range(height):
        here, row = places[i], np.uint64(i + 1) * pitch
        for n in range(words - 1):
            k = (i + 1) * words + n
            open_, first = field.most[k] & ~field.least[k], np.uint64(WORD * n)
            while open_ != _U0:
                j = first + trailing_zeros(open_)
                open_ &= open_ - _U1
                field.candidates[count] = row + j
                field.differences[row + j] = values[here[j]]
                count += 1
    return count


@njit(cache=True, nogil=True)
def _write_codes(field: Field, height: int, width: int) -> None:
    """Codes of all rows that an open cell is in or beside."""
    words, across = words_of(width), pitch_of(width) // CELLS_A_WORD
    dirty = field.dirty
    dirty[0] = dirty[height + 1] = 0
    for row in range(1, height + 1):
        open_ = _U0
        for k in range(row * words, (row + 1) * words):
            open_ |= field.most[k] & ~field.least[k]
        dirty[row] = np.uint8(open_ != _U0)
    whole = width // CELLS_A_WORD
    for row in range(1, height + 1):
        if not (dirty[row - 1] or dirty[row] or dirty[row + 1]):
            continue
        for eight in range(whole):
            k, place = row * words + eight // 8, _U8 * np.uint64(eight % 8)
            object_ = (field.least[k] >> place) & _BYTE
            open_ = ((field.most[k] >> place) & _BYTE) & ~object_
            codes = EXPANDED[object_] * _OBJECT | EXPANDED[open_] * _OPEN
            field.code_words[row * across + eight] = codes
        for j in range(whole * CELLS_A_WORD, width):
            k, place = row * words + j // WORD, np.uint64(j % WORD)
            code = np.uint8(OPEN) if field.most[k] >> place & _U1 else np.uint8(0)
            code = np.uint8(OBJECT) if field.least[k] >> place & _U1 else code
            field.codes[row * CELLS_A_WORD * across + j] = code


@njit(cache=True, nogil=True)
def bracket(field: Field, values: NDArray[np.int32], places: NDArray[np.uint32]) -> int:
    """Both bounds from the planes; cells between them are OPEN, and the first of the candidates.

    values[places[i, j]] is the difference of pixel (i, j). Returns how many cells are open.
    """
    height, width = places.shape
    words = words_of(width)
    _start(field, height, words)
    _settle(field, field.least, height, words)
    _settle(field, field.most, height, words)
    left = _list_open(field, values, places)
    if left:
        _write_codes(field, height, width)
    field.counts[UNDECIDED] = left
    return left


@njit(cache=True, nogil=True)
def take_decided(field: Field, height: int, width: int) -> None:
    """Open cells that have become OBJECT join the lower bound, which then is the minimum."""
    words, pitch = words_of(width), np.uint64(pitch_of(width))
    for row in range(1, height + 1):
        first = np.uint64(row) * pitch
        for n in range(words - 1):
            k = row * words + n
            open_, joined = field.most[k] & ~field.least[k], _U0
            while open_ != _U0:
                bit = open_ & (_U0 - open_)
                code = field.codes[first + np.uint64(WORD * n) + trailing_zeros(open_)]
                joined |= bit if code == OBJECT else _U0
                open_ ^= bit
            field.least[k] |= joined
