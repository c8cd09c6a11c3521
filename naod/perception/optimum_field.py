"""Buffers that the exact optimum works in, and what their cells mean.

Bounds are rows of bits, 64 cells a word (`naod.perception.bits`), with an empty row above the first
and below the last one. What the bounds leave open is cut in a field of bytes with a border.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.bits import words_of
from naod.perception.memory import LINE, Memory, int32s, int64s, uint8s, uint32s, uint64s

BACKGROUND, BORDER, OPEN, OBJECT = 0x00, 0x11, 0x20, 0x22
"""Codes of cells. The lower digit is 0, 1 or 2 for background, beyond the border and object while
an open cell is taken for background, the upper one the same while it is taken for object: four
neighbours' codes added up count both ways at once, and the border weighs on neither side."""

CELLS_A_WORD = 8

PLANES = 5
ENOUGH, HALF = (1 << PLANES) - 1, 1 << PLANES
"""A pixel's votes, one byte: bit k of ENOUGH is set where k of its four neighbours as object are
enough to make it object too; HALF where half a vote less would do: one that the border has not."""

CANDIDATES, UNDECIDED, WAVES, VISITS, LIFTS = range(5)
"""Counts of a solve: pixels that their own difference does not decide; pixels the bounds left open;
waves of the cut; cells that waves came by, each wave anew; single cells lifted between waves."""

# Cells are unsigned throughout: an index that may be negative costs a test at every access.
_ZERO, _ONE = np.uint64(0), np.uint64(1)


class Field(NamedTuple):
    """A field of (height, width) pixels.

    Pixel (i, j) is cell (i + 1) * pitch + j of the bytes, whose rows are whole words; the column
    after a row's last pixel is the border of that row and of the next. It is bit j of row i + 1 of
    the bits, whose rows have `words` words, the last one empty.
    """

    planes: NDArray[np.uint64]  # (PLANES, bit words), bit k of ENOUGH of all cells
    plane_bytes: NDArray[np.uint8]  # (PLANES, 8 bit words), the same memory
    least: NDArray[np.uint64]  # (bit words,), cells that are object in every minimum
    most: NDArray[np.uint64]  # (bit words,), cells that may be object
    dirty: NDArray[np.uint8]  # (height + 2,), rows beside which something changed
    votes: NDArray[np.uint8]  # (64 words,), a row of votes
    eights: NDArray[np.uint64]  # (8 words,), the same memory
    codes: NDArray[np.uint8]  # (cells,), right in and beside rows with open cells
    rows: NDArray[np.uint8]  # (height + 2, pitch), the same memory
    code_words: NDArray[np.uint64]  # (cells / 8,), the same memory
    differences: NDArray[np.int32]  # (cells,), of candidates only
    candidates: NDArray[np.uint32]  # (pixels + 1,), cells that the bounds left open
    pending: NDArray[np.uint32]  # (pixels + 1,), a stack of cells to come back to
    excess: NDArray[np.int32]  # (cells,), what a cell would cost as object; negative is a need
    residual: NDArray[np.int32]  # (cells, 4), capacity left to the left, right, up and down
    level: NDArray[np.int32]  # (cells,), steps to a need, 0 outside the component being cut
    nodes: NDArray[np.uint32]  # (pixels + 1,), cells of that component
    queue: NDArray[np.uint32]  # (pixels + 1,), those of them that reach a need, nearest first
    counts: NDArray[np.int64]  # (5,), see CANDIDATES


@njit(cache=True, nogil=True)
def pitch_of(width: int) -> int:
    """Cells of a row of bytes, its border included."""
    return -(-(width + 1) // CELLS_A_WORD) * CELLS_A_WORD


@njit(cache=True, nogil=True)
def field_in(memory: Memory, start: int, height: int, width: int) -> tuple[Field, int]:
    """A field cut from memory, and where that is free again."""
    cells, words = (height + 2) * pitch_of(width), words_of(width)
    # one more than there are pixels, so that a list may be written first and lengthened if it holds
    room = height * width + 1
    planes, at = uint64s(memory, start, PLANES * (height + 2) * words)
    least, at = uint64s(memory, at, (height + 2) * words)
    most, at = uint64s(memory, at, (height + 2) * words)
    dirty, at = uint8s(memory, at, height + 2)
    votes, at = uint8s(memory, at, 64 * words)
    codes, at = uint8s(memory, at, cells)
    counts, at = int64s(memory, at, 5)
    differences, at = int32s(memory, at, cells)
    level, at = int32s(memory, at, cells)
    excess, at = int32s(memory, at, cells)
    residual, at = int32s(memory, at, 4 * cells)
    candidates, at = uint32s(memory, at, room)
    pending, at = uint32s(memory, at, room)
    nodes, at = uint32s(memory, at, room)
    queue, at = uint32s(memory, at, room)
    field = Field(
        planes.reshape((PLANES, (height + 2) * words)),
        planes.view(np.uint8).reshape((PLANES, CELLS_A_WORD * (height + 2) * words)),
        least,
        most,
        dirty,
        votes,
        votes.view(np.uint64),
        codes,
        codes.reshape((height + 2, pitch_of(width))),
        codes.view(np.uint64),
        differences,
        candidates,
        pending,
        excess,
        residual.reshape((cells, 4)),
        level,
        nodes,
        queue,
        counts,
    )
    return field, at


def bytes_of_field(height: int, width: int) -> int:
    """Memory that a field takes, at the most."""
    cells = (height + 2) * (width + CELLS_A_WORD)
    words = (height + 2) * words_of(width)
    return 46 * cells + 8 * (PLANES + 2) * words + 64 * words_of(width) + 20 * LINE


def clear(field: Field) -> None:
    """Put the border up in fresh memory."""
    field.codes[:] = BORDER


@njit(cache=True, nogil=True)
def sides(field: Field) -> tuple[np.uint64, np.uint64, np.uint64, np.uint64]:
    """What to add to a cell for its left, right, upper and lower neighbour, modulo 2^64.

    Side k of a cell is side k ^ 1 of the neighbour.
    """
    pitch = np.uint64(field.rows.shape[1])
    return _ZERO - _ONE, _ONE, _ZERO - pitch, pitch


@njit(cache=True, nogil=True)
def votes_of(differences: NDArray[np.int32], beta: np.int32, votes: NDArray[np.uint8]) -> None:
    """ENOUGH and HALF of pixels by their differences, all four neighbours being in the picture.

    With k of them object, being object costs 4 - 2 k times beta more than its difference.
    """
    twice, thrice, four = np.int32(2 * beta), np.int32(3 * beta), np.int32(4 * beta)
    for j in range(differences.size):
        x = differences[j]
        enough = np.uint8(x < -four) | np.uint8(x < -twice) << np.uint8(1)
        enough |= np.uint8(x < np.int32(0)) << np.uint8(2) | np.uint8(x < twice) << np.uint8(3)
        enough |= np.uint8(x < four) << np.uint8(4)
        half = np.uint8(x >= -four) + np.uint8(x >= -thrice) + np.uint8(x >= -twice)
        half += np.uint8(x >= -beta) + np.uint8(x >= np.int32(0)) + np.uint8(x >= beta)
        half += np.uint8(x >= twice) + np.uint8(x >= thrice) + np.uint8(x >= four)
        votes[j] = np.uint8(enough | (half & np.uint8(1)) << np.uint8(5))


@njit(cache=True, nogil=True)
def neighbourhood(field: Field, cell: np.uint64) -> int:
    """Sum of the codes of the four neighbours."""
    left, right, up, down = sides(field)
    codes = field.codes
    across = np.int64(codes[cell + left]) + codes[cell + right]
    return across + codes[cell + up] + codes[cell + down]
