"""Buffers that the exact optimum works in, and what the cells of its padded field mean."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.memory import LINE, Memory, int32s, int64s, uint8s, uint32s, zeroed

BACKGROUND, BORDER, OPEN, OBJECT = 0x00, 0x11, 0x20, 0x22
"""Codes of cells. The lower digit is 0, 1 or 2 for background, beyond the border and object while
an open cell is taken for background, the upper one the same while it is taken for object: four
neighbours' codes added up count both ways at once, and the border weighs on neither side."""

ALWAYS, NEVER, NOWHERE = 0, 9, 10
"""Ends of the scale of needs, and that of the border. A cell joins the object when its neighbours'
lower digits come to its need at least, and leaves it when their upper ones fall short of it: the
digits of four neighbours come to 0 to 8."""

CELLS_A_WORD = 8

CANDIDATES, UNDECIDED, WAVES, VISITS, LIFTS = range(5)
"""Counts of a solve: pixels open once all rows were asked; pixels the bounds left open; waves of
the cut; cells that waves came by, each wave anew; single cells lifted between waves."""

# Cells are unsigned throughout: an index that may be negative costs a test at every access.
_ZERO, _ONE = np.uint64(0), np.uint64(1)


class Field(NamedTuple):
    """A field of (height, width) pixels with a border, its cells in rows of `pitch`.

    Pixel (i, j) is cell (i + 1) * pitch + j. Rows are whole words; the column after a row's last
    pixel is the border of that row and of the next.
    """

    codes: NDArray[np.uint8]  # (cells,)
    rows: NDArray[np.uint8]  # (height + 2, pitch), the same memory
    words: NDArray[np.uint64]  # (height + 2, pitch / 8), the same memory
    hot: NDArray[np.uint8]  # (height + 2,), rows that are not background altogether
    needs: NDArray[np.uint8]  # (height + 2, pitch), of each cell
    asked: NDArray[np.uint8]  # (cells,), codes that every other round of questions writes to
    differences: NDArray[np.int32]  # (cells,), of candidates only
    candidates: NDArray[np.uint32]  # (pixels + 1,), cells
    pending: NDArray[np.uint32]  # (pixels + 1,), a stack of cells to come back to
    excess: NDArray[np.int32]  # (cells,), what a cell would cost as object; negative is a need
    residual: NDArray[np.int32]  # (cells, 4), capacity left to the left, right, up and down
    level: NDArray[np.int32]  # (cells,), steps to a need, 0 outside the component being cut
    nodes: NDArray[np.uint32]  # (pixels + 1,), cells of that component
    queue: NDArray[np.uint32]  # (pixels + 1,), those of them that reach a need, nearest first
    counts: NDArray[np.int64]  # (5,), see CANDIDATES


@njit(cache=True, nogil=True)
def field_in(memory: Memory, start: int, height: int, width: int) -> tuple[Field, int]:
    """A field cut from memory, and where that is free again."""
    pitch = -(-(width + 1) // CELLS_A_WORD) * CELLS_A_WORD
    cells = (height + 2) * pitch
    # one more than there are pixels, so that a list may be written first and lengthened if it holds
    room = height * width + 1
    codes, at = uint8s(memory, start, cells)
    needs, at = uint8s(memory, at, cells)
    asked, at = uint8s(memory, at, cells)
    hot, at = uint8s(memory, at, height + 2)
    counts, at = int64s(memory, at, 5)
    differences, at = int32s(memory, at, cells)
    level, at = int32s(memory, at, cells)
    excess, at = int32s(memory, at, cells)
    residual, at = int32s(memory, at, 4 * cells)
    candidates, at = uint32s(memory, at, room)
    pending, at = uint32s(memory, at, room)
    nodes, at = uint32s(memory, at, room)
    queue, at = uint32s(memory, at, room)
    rows = codes.reshape((height + 2, pitch))
    words = codes.view(np.uint64).reshape((height + 2, pitch // CELLS_A_WORD))
    field = Field(
        codes,
        rows,
        words,
        hot,
        needs.reshape((height + 2, pitch)),
        asked,
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
    return 51 * cells + 16 * LINE


def clear(field: Field) -> None:
    """Put the border up in fresh memory."""
    field.codes[:] = field.asked[:] = BORDER
    field.needs[:] = NOWHERE


def empty_field(height: int, width: int) -> Field:
    """All the memory that fields of this size ever need."""
    field: Field = field_in(zeroed(bytes_of_field(height, width)), 0, height, width)[0]
    clear(field)
    return field


@njit(cache=True, nogil=True)
def sides(field: Field) -> tuple[np.uint64, np.uint64, np.uint64, np.uint64]:
    """What to add to a cell for its left, right, upper and lower neighbour, modulo 2^64.

    Side k of a cell is side k ^ 1 of the neighbour.
    """
    pitch = np.uint64(field.rows.shape[1])
    return _ZERO - _ONE, _ONE, _ZERO - pitch, pitch


@njit(cache=True, nogil=True)
def needs_of(differences: NDArray[np.int32], beta: np.int32, needs: NDArray[np.uint8]) -> None:
    """What neighbours' lower digits must come to; 4 + k of them are worth k times beta."""
    twice, thrice, four = np.int32(2 * beta), np.int32(3 * beta), np.int32(4 * beta)
    for j in range(differences.size):
        x = differences[j]
        near = np.uint8(x >= 0) + np.uint8(x >= beta) + np.uint8(x >= -beta)
        far = np.uint8(x >= twice) + np.uint8(x >= -twice)
        farther = np.uint8(x >= thrice) + np.uint8(x >= -thrice)
        farthest = np.uint8(x >= four) + np.uint8(x >= -four)
        needs[j] = np.uint8(near + far + farther + farthest)


@njit(cache=True, nogil=True)
def neighbourhood(field: Field, cell: np.uint64) -> int:
    """Sum of the codes of the four neighbours."""
    left, right, up, down = sides(field)
    codes = field.codes
    across = np.int64(codes[cell + left]) + codes[cell + right]
    return across + codes[cell + up] + codes[cell + down]
