"""Richardson (1972) and Lucy (1974): towards the likeliest picture under Poisson noise."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from naod.bench.peers.restored import Restored

ITERATIONS = 5
"""Of 5 to 40 the best mask at 33 ms: noise grows with every one."""

LEAST_LEVEL = 1.0


def undo(picture: NDArray[np.float32], kernel: NDArray[np.float32]) -> NDArray[np.float32]:
    """Levels are positive in all three channels, which is all that the iteration asks for."""
    seen = np.maximum(picture, LEAST_LEVEL)
    sharp = seen.copy()
    # cv2.filter2D correlates: it blurs with the mirrored kernel and goes back with the kernel
    mirrored = np.ascontiguousarray(kernel[::-1, ::-1])
    for _ in range(ITERATIONS):
        ratio = seen / np.maximum(_filtered(sharp, mirrored), LEAST_LEVEL)
        sharp *= _filtered(ratio, kernel)
    return sharp


def _filtered(picture: NDArray[np.float32], kernel: NDArray[np.float32]) -> NDArray[np.float32]:
    return np.asarray(
        cv2.filter2D(picture, -1, kernel, borderType=cv2.BORDER_REFLECT), dtype=np.float32
    )


def make(size: tuple[int, int]) -> Restored:
    """For pictures of that size."""
    return Restored(size, undo)
