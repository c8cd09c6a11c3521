"""Arrays cut from one stretch of memory, so that compiled code is handed one instead of dozens.

Every array that Python hands over costs time, a microsecond each when caches are cold.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

Memory = NDArray[np.uint8]
LINE = 64
"""Bytes of a cache line; every array begins with one."""


def zeroed(size: int) -> Memory:
    """Fresh memory that begins with a cache line."""
    memory = np.zeros(size + LINE, dtype=np.uint8)
    return memory[-memory.ctypes.data % LINE :][:size]


@njit(cache=True, nogil=True)
def after(at: int, size: int) -> int:
    """Where the next array begins after one of `size` bytes."""
    return at + -(-size // LINE) * LINE


@njit(cache=True, nogil=True)
def int32s(memory: Memory, at: int, count: int) -> tuple[NDArray[np.int32], int]:
    """So many from there on, and where the next array begins."""
    return memory[at : at + 4 * count].view(np.int32), after(at, 4 * count)


@njit(cache=True, nogil=True)
def uint32s(memory: Memory, at: int, count: int) -> tuple[NDArray[np.uint32], int]:
    """So many from there on, and where the next array begins."""
    return memory[at : at + 4 * count].view(np.uint32), after(at, 4 * count)


@njit(cache=True, nogil=True)
def int64s(memory: Memory, at: int, count: int) -> tuple[NDArray[np.int64], int]:
    """So many from there on, and where the next array begins."""
    return memory[at : at + 8 * count].view(np.int64), after(at, 8 * count)


@njit(cache=True, nogil=True)
def uint64s(memory: Memory, at: int, count: int) -> tuple[NDArray[np.uint64], int]:
    """So many from there on, and where the next array begins."""
    return memory[at : at + 8 * count].view(np.uint64), after(at, 8 * count)


@njit(cache=True, nogil=True)
def float64s(memory: Memory, at: int, count: int) -> tuple[NDArray[np.float64], int]:
    """So many from there on, and where the next array begins."""
    return memory[at : at + 8 * count].view(np.float64), after(at, 8 * count)


@njit(cache=True, nogil=True)
def uint8s(memory: Memory, at: int, count: int) -> tuple[NDArray[np.uint8], int]:
    """So many from there on, and where the next array begins."""
    return memory[at : at + count], after(at, count)
