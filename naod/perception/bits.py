"""Rows of yes and no, 64 columns a word: bit k of word n is column 64 n + k."""

from __future__ import annotations

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic
from numpy.typing import NDArray

WORD = 64

_ONES = np.uint64(0x0101010101010101)
_SEVEN = np.uint64(0x7F7F7F7F7F7F7F7F)
_GATHER = np.uint64(0x0102040810204080)
_ODD_PAIRS, _ODD_FOURS = np.uint64(0x00AA00AA00AA00AA), np.uint64(0x0000CCCC0000CCCC)
_ODD_EIGHTS = np.uint64(0x00000000F0F0F0F0)
_U0, _U1, _U7, _U8, _U14, _U28, _U56 = (np.uint64(n) for n in (0, 1, 7, 8, 14, 28, 56))
_BYTE = np.uint64(0xFF)

EXPANDED = np.array(
    [sum((byte >> k & 1) << (8 * k) for k in range(8)) for byte in range(256)], dtype=np.uint64
)
"""(256,) a byte's bits as eight bytes, 0 or 1, the lowest bit first in memory."""


@intrinsic
def trailing_zeros(_context, _word):  # type: ignore[no-untyped-def]
    """Place of the lowest bit of a uint64 that is not 0."""

    def code(_context, builder, _signature, arguments):  # type: ignore[no-untyped-def]
        return builder.cttz(arguments[0], ir.Constant(ir.IntType(1), 1))

    return types.uint64(types.uint64), code


@intrinsic
def ones(_context, _word):  # type: ignore[no-untyped-def]
    """How many bits of a uint64 are set."""

    def code(_context, builder, _signature, arguments):  # type: ignore[no-untyped-def]
        return builder.ctpop(arguments[0])

    return types.uint64(types.uint64), code


@njit(cache=True, nogil=True)
def words_of(width: int) -> int:
    """Words of a row of so many columns, with an empty one behind them that parts the rows."""
    return -(-width // WORD) + 1


@njit(cache=True, nogil=True)
def _lowest_bits(word: np.uint64) -> np.uint64:
    """The lowest bit of each of a word's eight bytes, the first byte's first."""
    return ((word & _ONES) * _GATHER) >> _U56


@njit(cache=True, nogil=True)
def transpose(eights: NDArray[np.uint64], count: int) -> None:
    """Of the first `count` words: bit k of byte n becomes bit n of byte k.

    Three exchanges of ever larger blocks (Warren, Hacker's Delight, 7-3).
    """
    for k in range(count):
        word = eights[k]
        change = (word ^ (word >> _U7)) & _ODD_PAIRS
        word ^= change ^ (change << _U7)
        change = (word ^ (word >> _U14)) & _ODD_FOURS
        word ^= change ^ (change << _U14)
        change = (word ^ (word >> _U28)) & _ODD_EIGHTS
        eights[k] = word ^ change ^ (change << _U28)


@njit(cache=True, nogil=True)
def pack(mask: NDArray[np.uint8], bits: NDArray[np.uint64]) -> None:
    """Bits of what is not zero in (h, w), into rows of `words_of(w)` words."""
    height, width = mask.shape
    bits[:] = _U0
    pitch = words_of(width)
    whole = width // 8
    if width % 8 == 0:
        eights = mask.reshape(-1).view(np.uint64)
        for i in range(height):
            for k in range(whole):
                word = eights[i * whole + k]
                if word != _U0:
                    seen = (((word & _SEVEN) + _SEVEN) | word) >> _U7
                    bits[i * pitch + k // 8] |= _lowest_bits(seen) << (_U8 * np.uint64(k % 8))
        return
    for i in range(height):
        for j in range(width):
            if mask[i, j]:
                bits[i * pitch + j // WORD] |= _U1 << np.uint64(j % WORD)


@njit(cache=True, nogil=True)
def unpack(bits: NDArray[np.uint64], mask: NDArray[np.uint8]) -> None:
    """The way back: 0 and 1 of every column into (h, w)."""
    height, width = mask.shape
    pitch = words_of(width)
    if width % 8 == 0:
        whole, eights = width // 8, mask.reshape(-1).view(np.uint64)
        for i in range(height):
            for k in range(whole):
                byte = (bits[i * pitch + k // 8] >> (_U8 * np.uint64(k % 8))) & _BYTE
                eights[i * whole + k] = EXPANDED[byte]
        return
    for i in range(height):
        for j in range(width):
            mask[i, j] = np.uint8((bits[i * pitch + j // WORD] >> np.uint64(j % WORD)) & _U1)
