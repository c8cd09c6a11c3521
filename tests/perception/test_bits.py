"""Rows of bits against numpy's own packing."""

from __future__ import annotations

import numpy as np
import pytest
from numba import njit
from numpy.typing import NDArray

from naod.perception.bits import ones, pack, trailing_zeros, transpose, unpack, words_of

SHAPES = [(1, 1), (3, 8), (5, 63), (4, 64), (7, 65), (6, 160), (2, 200)]


@njit
def counted(words: NDArray[np.uint64], out: NDArray[np.uint64]) -> None:
    for k in range(words.size):
        out[k, 0], out[k, 1] = ones(words[k]), trailing_zeros(words[k])


def words(seed: int, count: int) -> NDArray[np.uint64]:
    return np.random.default_rng(seed).integers(0, 2**64, count, dtype=np.uint64)


@pytest.mark.parametrize("shape", SHAPES)
def test_rows_are_packed_as_numpy_packs_them(shape: tuple[int, int]) -> None:
    mask = np.random.default_rng(1).integers(0, 3, shape).astype(np.uint8) * np.uint8(100)
    height, width = shape
    bits = np.ones(height * words_of(width), dtype=np.uint64)
    pack(mask, bits)
    expected = np.zeros((height, 64 * words_of(width)), dtype=np.uint8)
    expected[:, :width] = mask != 0
    packed = np.packbits(expected, axis=1, bitorder="little").reshape(-1).view(np.uint64)
    assert (bits == packed).all()
    back = np.full(shape, 7, dtype=np.uint8)
    unpack(bits, back)
    assert (back == (mask != 0)).all()


def test_bits_are_counted_and_found_as_in_text() -> None:
    given = np.concatenate([words(2, 200) >> np.arange(200, dtype=np.uint64) % 64, [1, 1 << 63]])
    given = given[given != 0].astype(np.uint64)
    out = np.zeros((len(given), 2), dtype=np.uint64)
    counted(given, out)
    for word, (count, place) in zip(given.tolist(), out.tolist(), strict=True):
        text = f"{word:b}"
        assert (count, place) == (text.count("1"), len(text) - 1 - text.rindex("1"))


def test_transposing_exchanges_bytes_and_bits() -> None:
    given = words(3, 50)
    turned = given.copy()
    transpose(turned, 49)
    squares = [
        np.unpackbits(w.view(np.uint8).reshape(-1, 8), axis=1, bitorder="little").reshape(-1, 8, 8)
        for w in (given, turned)
    ]
    assert (squares[0][:49].transpose(0, 2, 1) == squares[1][:49]).all()
    assert turned[49] == given[49]
