"""From linear light to the picture a camera delivers: sRGB, YUYV, sensor noise. numba kernel."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from hal.yuyv import yuv_from_rgb
from sim_backend.colour import LEVELS, srgb_from_linear

_NOISE_BITS = 16
# columns are what full red, green and blue alone give; the constants stay in one place, hal.yuyv
_YUV_FROM_RGB: NDArray[np.float32] = np.ascontiguousarray(
    (yuv_from_rgb(np.eye(3, dtype=np.float32)) - np.array([0, 128, 128], dtype=np.float32)).T
)


@njit(cache=True, nogil=True)
def _draw(noise, place):  # type: ignore[no-untyped-def]
    """The noise of a value: a number of the frame's own, picked by the place."""
    mixed = (place * 2654435769) & 0xFFFFFFFF
    mixed ^= mixed >> 15
    mixed = (mixed * 2246822519) & 0xFFFFFFFF
    return noise[mixed >> (32 - _NOISE_BITS)]


@njit(cache=True, nogil=True)
def _level(value, noise, place):  # type: ignore[no-untyped-def]
    level = np.rint(value + _draw(noise, place))
    return np.uint8(min(max(level, np.float32(0.0)), np.float32(255.0)))


@njit(cache=True, nogil=True)
def _develop(linear, levels, M, noise, out):  # type: ignore[no-untyped-def]
    height, width = linear.shape[0], linear.shape[1]
    top = np.float32(levels.shape[0] - 1)
    half, middle = np.float32(0.5), np.float32(128.0)
    rgb = np.empty(3, dtype=np.float32)
    for i in range(height):
        for j in range(0, width, 2):
            u = v = np.float32(0.0)
            for side in range(2):
                for channel in range(3):
                    light = min(max(linear[i, j + side, channel], np.float32(0.0)), np.float32(1.0))
                    rgb[channel] = levels[int(light * top + half)]
                y = M[0, 0] * rgb[0] + M[0, 1] * rgb[1] + M[0, 2] * rgb[2]
                u += M[1, 0] * rgb[0] + M[1, 1] * rgb[1] + M[1, 2] * rgb[2]
                v += M[2, 0] * rgb[0] + M[2, 1] * rgb[1] + M[2, 2] * rgb[2]
                place = 2 * (i * width + j + side)
                out[i, j + side, 0] = _level(y, noise, place)
            place = 2 * (i * width + j) + 1
            out[i, j, 1] = _level(half * u + middle, noise, place)
            out[i, j + 1, 1] = _level(half * v + middle, noise, place + 2)


def developed(
    linear: NDArray[np.float32], noise_std: float, rng: np.random.Generator
) -> NDArray[np.uint8]:
    """Linear light (height, width, 3) to YUYV (height, width, 2) uint8; width must be even.

    `noise_std` in levels of Y, U and V.
    """
    if linear.shape[1] % 2:
        raise ValueError(f"YUYV needs an even width, got {linear.shape[1]}")
    noise = rng.standard_normal(1 << _NOISE_BITS, dtype=np.float32) * np.float32(noise_std)
    out = np.empty((*linear.shape[:2], 2), dtype=np.uint8)
    _develop(linear, LEVELS, _YUV_FROM_RGB, noise, out)
    return out


def rgb_levels(linear: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Linear light, any shape, to sRGB levels, uint8."""
    return np.rint(srgb_from_linear(linear)).astype(np.uint8)
