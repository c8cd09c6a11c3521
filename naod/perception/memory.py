"""Arrays cut from one stretch of memory, so that compiled code is handed one instead of dozens.

Every array that Python hands over costs time, a microsecond each when caches are cold. What is cut
does not count as holding the memory: counting costs time too, for every row that is taken of an
array. Python gets views that do (`views_of`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic
from numba.np.arrayobj import make_array, populate_array
from numpy.typing import NDArray

Memory = NDArray[np.uint8]
LINE = 64
"""Bytes of a cache line; every array begins with one."""


def zeroed(size: int) -> Memory:
    """Fresh memory that begins with a cache line."""
    memory = np.zeros(size + LINE, dtype=np.uint8)
    return memory[-memory.ctypes.data % LINE :][:size]


@intrinsic
def _cut(_context, memory, _at, _count, kind):  # type: ignore[no-untyped-def]
    """An array of so many values from byte `at` on, which must lie in the memory."""
    array = types.Array(kind.dtype, 1, "C")

    def code(context, builder, _signature, arguments):  # type: ignore[no-untyped-def]
        source = make_array(memory)(context, builder, arguments[0])
        cut, value = make_array(array)(context, builder), context.get_data_type(kind.dtype)
        first = builder.bitcast(builder.gep(source.data, [arguments[1]]), value.as_pointer())
        size = context.get_constant(types.intp, context.get_abi_sizeof(value))
        populate_array(
            cut, data=first, shape=[arguments[2]], strides=[size], itemsize=size, meminfo=None
        )
        return cut._getvalue()

    return array(memory, types.intp, types.intp, kind), code


@intrinsic
def fetch(_context, words, _k):  # type: ignore[no-untyped-def]
    """Ask for the cache line that words[k] lies in, to be read soon; nothing waits for it."""

    def code(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        array = make_array(signature.args[0])(context, builder, arguments[0])
        byte, whole = ir.IntType(8).as_pointer(), ir.IntType(32)
        place = builder.bitcast(builder.gep(array.data, [arguments[1]]), byte)
        # for reading, into all caches, data
        how = [whole(0), whole(3), whole(1)]
        kind = ir.FunctionType(ir.VoidType(), [byte, whole, whole, whole])
        call = builder.module.declare_intrinsic("llvm.prefetch", (byte,), kind)
        builder.call(call, [place, *how])
        return context.get_dummy_value()

    return types.void(words, types.intp), code


def views_of(memory: Memory, arrays: Iterable[NDArray[Any]]) -> Iterator[NDArray[Any]]:
    """Arrays that compiled code cut from memory, as views that hold the memory itself.

    Whoever holds such a view, or a view of it, can be told from the memory's references.
    """
    for array in arrays:
        start = array.ctypes.data - memory.ctypes.data
        yield memory[start : start + array.nbytes].view(array.dtype).reshape(array.shape)


@njit(cache=True, nogil=True)
def after(at: int, size: int) -> int:
    """Where the next array begins after one of `size` bytes."""
    return at + -(-size // LINE) * LINE


@njit(cache=True, nogil=True)
def int32s(memory: Memory, at: int, count: int) -> tuple[NDArray[np.int32], int]:
    """So many from there on, and where the next array begins."""
    return _cut(memory, at, count, np.int32), after(at, 4 * count)


@njit(cache=True, nogil=True)
def uint32s(memory: Memory, at: int, count: int) -> tuple[NDArray[np.uint32], int]:
    """So many from there on, and where the next array begins."""
    return _cut(memory, at, count, np.uint32), after(at, 4 * count)


@njit(cache=True, nogil=True)
def int64s(memory: Memory, at: int, count: int) -> tuple[NDArray[np.int64], int]:
    """So many from there on, and where the next array begins."""
    return _cut(memory, at, count, np.int64), after(at, 8 * count)


@njit(cache=True, nogil=True)
def uint64s(memory: Memory, at: int, count: int) -> tuple[NDArray[np.uint64], int]:
    """So many from there on, and where the next array begins."""
    return _cut(memory, at, count, np.uint64), after(at, 8 * count)


@njit(cache=True, nogil=True)
def float64s(memory: Memory, at: int, count: int) -> tuple[NDArray[np.float64], int]:
    """So many from there on, and where the next array begins."""
    return _cut(memory, at, count, np.float64), after(at, 8 * count)


@njit(cache=True, nogil=True)
def uint8s(memory: Memory, at: int, count: int) -> tuple[NDArray[np.uint8], int]:
    """So many from there on, and where the next array begins."""
    return _cut(memory, at, count, np.uint8), after(at, count)
