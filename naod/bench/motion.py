"""What a straight, even motion makes of a picture while the shutter is open."""

from __future__ import annotations

import math

import cv2
import numpy as np
from numpy.typing import NDArray

LEAST_PX = 0.5
"""Motions shorter than that leave a picture as it is."""


def motion_kernel(dx: float, dy: float) -> NDArray[np.float32]:
    """A straight, even motion's, odd square, sum 1, centred on its middle."""
    half = math.ceil(max(abs(dx), abs(dy)) / 2.0) + 1
    kernel = np.zeros((2 * half + 1, 2 * half + 1), dtype=np.float32)
    for along in (np.arange(64) + 0.5) / 64.0 - 0.5:
        x, y = half + along * dx, half + along * dy
        j, i = int(x), int(y)
        down, right = np.array([1.0 - (y - i), y - i]), np.array([1.0 - (x - j), x - j])
        kernel[i : i + 2, j : j + 2] += np.outer(down, right)
    return kernel / kernel.sum()


def smeared(light: NDArray[np.float32], motion_px: tuple[float, float]) -> NDArray[np.float32]:
    """Linear light (H, W, 3) of a picture that moves so far; its borders go on beyond it."""
    if math.hypot(*motion_px) < LEAST_PX:
        return light
    kernel = motion_kernel(*motion_px)
    out = cv2.filter2D(light, -1, kernel, borderType=cv2.BORDER_REPLICATE)
    return np.asarray(out, dtype=np.float32)
