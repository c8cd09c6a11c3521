"""From a camera's YUYV bytes to the places of block means in a table of colours, row by row.

Y, U and V are kept to Y_BITS, C_BITS and C_BITS bits. Eight bytes are added up at once: the even
ones, Y, and the odd ones, U and V, each in four lanes of 16 bits, which hold blocks up to 16 x 16.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.memory import LINE, Memory, fetch, uint8s, uint64s

Y_BITS, C_BITS = 5, 6
CELLS = 1 << (Y_BITS + 2 * C_BITS)

ANY_BLOCK, WORDS_4 = 0, 4
"""Kinds of blocks: of any size; 4 x 4, one word wide. Others of 1, 2, 8 and 16 are their side."""

_ROWS_AHEAD = 8
"""Memory is asked for so many rows before it is read. Four rows read side by side are more than a
processor looks ahead for by itself."""

_WORDS_A_LINE = LINE // 8

_LANES = np.uint64(0x00FF00FF00FF00FF)
_LANE = np.uint64(0xFFFF)
_U0, _U1, _U3, _U8, _U16, _U32 = (np.uint64(n) for n in (0, 1, 3, 8, 16, 32))
_U_SHIFT, _Y_SHIFT = np.uint64(C_BITS), np.uint64(2 * C_BITS)
# of a block of 4 x 4: a compiler that knows them shifts several sums at once
_Y_CUT_4, _C_CUT_4 = np.uint64(4 + 8 - Y_BITS), np.uint64(3 + 8 - C_BITS)


class Picture(NamedTuple):
    """A picture's bytes and the same as words, read-only; scratch for a row of blocks.

    `words` is (H, W / 4), or (0, 0) where blocks are of ANY_BLOCK.
    """

    raw: NDArray[np.uint8]  # (H, 2 W)
    words: NDArray[np.uint64]
    flat: NDArray[np.uint64]  # (H W / 4,), or (0,)
    sums: NDArray[np.uint64]  # (2, 2 W): of each byte, or the even and odd lanes of each word


@njit(cache=True, nogil=True)
def picture_in(
    memory: Memory, start: int, raw: NDArray[np.uint8], kind: int
) -> tuple[Picture, int]:
    """A picture (H, W, 2) with scratch cut from memory, and where that is free again."""
    height, across = raw.shape[0], 2 * raw.shape[1]
    lines, _ = uint8s(raw, 0, raw.size)
    flat, _ = uint64s(raw, 0, 0 if kind == ANY_BLOCK else raw.size // 8)
    shape = (0, 0) if kind == ANY_BLOCK else (height, across // 8)
    sums, at = uint64s(memory, start, 2 * across)
    lines = lines.reshape((height, across))
    return Picture(lines, flat.reshape(shape), flat, sums.reshape((2, across))), at


def bytes_of_picture(width: int) -> int:
    """Memory that a picture's scratch takes."""
    return 32 * width + 2 * LINE


@njit(cache=True, nogil=True)
def _fetch_rows(picture: Picture, row: int) -> None:
    """Ask for four rows of a picture that are read next; beyond its end for nothing."""
    across = picture.words.shape[1]
    for k in range(row * across, min((row + 4) * across, picture.flat.size), _WORDS_A_LINE):
        fetch(picture.flat, k)


@njit(cache=True, nogil=True)
def _by_words_of_four(words: NDArray[np.uint64], top: int, out: NDArray[np.uint32]) -> None:
    """One word of each of four rows is one block."""
    # not unpacked: rows got that way are not known to be contiguous, and loops over them are slow
    first, second, third, fourth = words[top], words[top + 1], words[top + 2], words[top + 3]
    for j in range(out.size):
        a, b, c, d = first[j], second[j], third[j], fourth[j]
        y = (a & _LANES) + (b & _LANES) + (c & _LANES) + (d & _LANES)
        uv = ((a >> _U8) & _LANES) + ((b >> _U8) & _LANES)
        uv += ((c >> _U8) & _LANES) + ((d >> _U8) & _LANES)
        y += y >> _U32
        y += y >> _U16
        uv += uv >> _U32
        u, v = (uv & _LANE) >> _C_CUT_4, ((uv >> _U16) & _LANE) >> _C_CUT_4
        out[j] = (((y & _LANE) >> _Y_CUT_4) << _Y_SHIFT) | (u << _U_SHIFT) | v


@njit(cache=True, nogil=True)
def _add_words(
    words: NDArray[np.uint64],
    top: int,
    rows: int,
    even: NDArray[np.uint64],
    odd: NDArray[np.uint64],
) -> None:
    """Lanes of each word's even and odd bytes, added up over rows."""
    first = words[top]
    for k in range(first.size):
        even[k] = first[k] & _LANES
        odd[k] = (first[k] >> _U8) & _LANES
    for i in range(top + 1, top + rows):
        line = words[i]
        for k in range(line.size):
            even[k] += line[k] & _LANES
            odd[k] += (line[k] >> _U8) & _LANES


@njit(cache=True, nogil=True)
def _by_several_words(
    sums: NDArray[np.uint64],
    across: int,
    y_cut: np.uint64,
    c_cut: np.uint64,
    out: NDArray[np.uint32],
) -> None:
    """`across` words side by side are one block."""
    even, odd = sums[0], sums[1]
    for j in range(out.size):
        y = uv = _U0
        for k in range(j * across, (j + 1) * across):
            y += even[k]
            uv += odd[k]
        y += y >> _U32
        y += y >> _U16
        uv += uv >> _U32
        u, v = (uv & _LANE) >> c_cut, ((uv >> _U16) & _LANE) >> c_cut
        out[j] = (((y & _LANE) >> y_cut) << _Y_SHIFT) | (u << _U_SHIFT) | v


@njit(cache=True, nogil=True)
def _by_parts_of_a_word(
    sums: NDArray[np.uint64],
    block: int,
    y_cut: np.uint64,
    c_cut: np.uint64,
    out: NDArray[np.uint32],
) -> None:
    """A word is two blocks of 2 x 2 or four single pixels; a pair of pixels shares U and V."""
    even, odd = sums[0], sums[1]
    for j in range(out.size):
        column = j * block
        k, lane = column // 4, np.uint64(column % 4)
        y = even[k] >> (lane * _U16)
        uv = odd[k] >> ((lane >> _U1) * _U32)
        if block == 2:
            y += y >> _U16
        u, v = (uv & _LANE) >> c_cut, ((uv >> _U16) & _LANE) >> c_cut
        out[j] = (((y & _LANE) >> y_cut) << _Y_SHIFT) | (u << _U_SHIFT) | v


@njit(cache=True, nogil=True)
def _by_bytes(
    raw: NDArray[np.uint8], row: int, block: int, sums: NDArray[np.uint64], out: NDArray[np.uint32]
) -> None:
    """Blocks of any size, cut off where the picture ends."""
    top, bottom = row * block, min((row + 1) * block, raw.shape[0])
    columns = raw.shape[1] // 2
    sums[:] = _U0
    for i in range(top, bottom):
        line = raw[i]
        for k in range(line.size):
            sums[k] += np.uint64(line[k])
    for j in range(out.size):
        left, right = j * block, min((j + 1) * block, columns)
        y = u = v = _U0
        for column in range(left, right):
            pair = 4 * (column // 2)
            y += sums[2 * column]
            u += sums[pair + 1]
            v += sums[pair + 3]
        pixels = np.uint64((bottom - top) * (right - left))
        y //= pixels << np.uint64(8 - Y_BITS)
        u //= pixels << np.uint64(8 - C_BITS)
        v //= pixels << np.uint64(8 - C_BITS)
        out[j] = (y << _Y_SHIFT) | (u << _U_SHIFT) | v


@njit(cache=True, nogil=True)
def _power(block: int) -> int:
    """Of two, that a block's side is."""
    power = 0
    while 1 << power < block:
        power += 1
    return power


@njit(cache=True, nogil=True)
def cells_of_fours(picture: Picture, row: int, out: NDArray[np.uint32]) -> None:
    """As `cells_of_row` of WORDS_4."""
    _fetch_rows(picture, 4 * row + _ROWS_AHEAD)
    _by_words_of_four(picture.words, 4 * row, out)


@njit(cache=True, nogil=True)
def cells_of_row(
    picture: Picture, kind: int, block: int, row: int, out: NDArray[np.uint32]
) -> None:
    """Places (w,) uint32 in a table of CELLS of one row of blocks."""
    if kind == ANY_BLOCK:
        _by_bytes(picture.raw, row, block, picture.sums[0], out)
        return
    if kind == WORDS_4:
        cells_of_fours(picture, row, out)
        return
    # a block of 2^p x 2^p has 2^2p samples of Y and half as many of U and V, a single pixel as many
    power = _power(block)
    y_cut = np.uint64(2 * power + 8 - Y_BITS)
    c_cut = np.uint64(max(2 * power - 1, 0) + 8 - C_BITS)
    _add_words(picture.words, row * block, block, picture.sums[0], picture.sums[1])
    if block < 4:
        _by_parts_of_a_word(picture.sums, block, y_cut, c_cut, out)
    else:
        _by_several_words(picture.sums, block // 4, y_cut, c_cut, out)


def kind_of(size: tuple[int, int], block: int) -> int:
    """How blocks of a picture of (width, height) are added up."""
    width, height = size
    fits = width % max(block, 4) == 0 and height % block == 0
    return block if fits and block in (1, 2, 4, 8, 16) else ANY_BLOCK
