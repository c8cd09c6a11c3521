"""A camera's YUYV picture made small, in one pass over its bytes."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True)
def _reduce(
    raw: NDArray[np.uint8],
    block: int,
    sums: NDArray[np.uint32],
    out: NDArray[np.float32],
) -> None:
    rows, columns = raw.shape[0], raw.shape[1] // 2
    for i in range(out.shape[0]):
        top, bottom = i * block, min((i + 1) * block, rows)
        sums[:] = 0
        for row in range(top, bottom):
            line = raw[row]
            for k in range(line.size):
                sums[k] += line[k]
        for j in range(out.shape[1]):
            left, right = j * block, min((j + 1) * block, columns)
            luma = u = v = np.uint32(0)
            for column in range(left, right):
                pair = 4 * (column // 2)
                luma += sums[2 * column]
                u += sums[pair + 1]
                v += sums[pair + 3]
            scale = np.float32(1.0) / np.float32((bottom - top) * (right - left))
            out[i, j, 0] = luma * scale
            out[i, j, 1] = u * scale
            out[i, j, 2] = v * scale


class Reduction:
    """Box means over blocks of `block` x `block` pixels; blocks at the far edges may be smaller.

    A reduced pixel (column j) covers full columns j * block to (j + 1) * block - 1. Chroma of a
    pixel is that of its pair. `size` is (width, height) of the full picture, `width_max` the
    greatest reduced width.
    """

    def __init__(self, size: tuple[int, int], width_max: int) -> None:
        width, height = size
        self.size = size
        self.block = max(1, -(-width // width_max))
        self.width = -(-width // self.block)
        self.height = -(-height // self.block)
        self._sums = np.zeros(2 * width, dtype=np.uint32)
        self.picture = np.empty((self.height, self.width, 3), dtype=np.float32)

    def __call__(self, yuyv: NDArray[np.uint8]) -> NDArray[np.float32]:
        """(H, W, 2) uint8 to (h, w, 3) float32, Y U V; the same buffer every time."""
        width, height = self.size
        if yuyv.shape != (height, width, 2) or yuyv.dtype != np.uint8:
            raise ValueError(f"expected a uint8 YUYV picture {width}x{height}, got {yuyv.shape}")
        raw = np.ascontiguousarray(yuyv).reshape(height, 2 * width)
        _reduce(raw, self.block, self._sums, self.picture)
        return self.picture
