"""How a camera turns light into levels, and where that leaves the middle of an edge.

Lens, pixel and motion mix light; the level a pixel gets is a curve of the mixture; the chroma of a
pair of pixels is a mean of levels. So a profile across an edge is symmetric in neither, and the
level at the edge itself is not half-way between the plateaus: for yellow before grey it would be
0.2 to 0.4 pixels off.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

_LEVELS = np.arange(256) / 255.0
LIGHT = np.where(_LEVELS <= 0.04045, _LEVELS / 12.92, ((_LEVELS + 0.055) / 1.055) ** 2.4)
"""Light, 0 to 1, of an 8-bit level by the sRGB curve (IEC 61966-2-1), near which cameras stay."""

LEVEL = 255.0 * np.interp((np.arange(258) / 256.0) ** 2, LIGHT, _LEVELS)
"""The way back: level, 0 to 255, of light (k / 256) squared."""

NODES = 5
SPREAD_LUMA2 = 1.0 / 6.0
"""Variance of a bilinear sample, pixels squared, along any direction."""

SPREAD_CHROMA2 = 0.25 + 4.0 / 6.0
"""The same of chroma along a row: the mean of a pair, then bilinear between pairs."""


@njit(cache=True, nogil=True)
def light_of(level: float) -> float:
    """Light of a level between the whole ones, too."""
    level = min(max(level, 0.0), 254.999)
    k = int(level)
    return LIGHT[k] + (level - k) * (LIGHT[k + 1] - LIGHT[k])


@njit(cache=True, nogil=True)
def level_of(light: float) -> float:
    """Level of light in 0 to 1."""
    place = 256.0 * math.sqrt(light)
    k = int(place)
    return LEVEL[k] + (place - k) * (LEVEL[k + 1] - LEVEL[k])


@njit(cache=True, nogil=True)
def lights(yuv: NDArray[np.float64], out: NDArray[np.float64]) -> None:
    """Light of red, green and blue (3,) of a colour Y, U, V (3,)."""
    u, v = yuv[1] - 128.0, yuv[2] - 128.0
    out[0] = light_of(yuv[0] + 1.402 * v)
    out[1] = light_of(yuv[0] - 0.344136 * u - 0.714136 * v)
    out[2] = light_of(yuv[0] + 1.772 * u)


@njit(cache=True, nogil=True)
def mixed_colour(
    inner: NDArray[np.float64],
    outer: NDArray[np.float64],
    width: float,
    sigma_luma: float,
    sigma_chroma: float,
    out: NDArray[np.float64],
) -> None:
    """Y, U, V (3,) that a sample at the very edge has on average.

    inner, outer: light (3,) on either side, mixing over `width` pixels; the sigmas are how far
    luma and chroma samples gather the levels around them, in pixels.
    """
    for c in range(3):
        out[c] = 0.0
    for part in range(2):
        sigma = sigma_luma if part == 0 else sigma_chroma
        for k in range(NODES):
            at = (2.0 * k / (NODES - 1) - 1.0) * 1.2247 * sigma
            share = min(max(0.5 + at / width, 0.0), 1.0)
            red = level_of(inner[0] + share * (outer[0] - inner[0]))
            green = level_of(inner[1] + share * (outer[1] - inner[1]))
            blue = level_of(inner[2] + share * (outer[2] - inner[2]))
            if part == 0:
                out[0] += (0.299 * red + 0.587 * green + 0.114 * blue) / NODES
            else:
                out[1] += (-0.168736 * red - 0.331264 * green + 0.5 * blue) / NODES
                out[2] += (0.5 * red - 0.418688 * green - 0.081312 * blue) / NODES
    out[1] += 128.0
    out[2] += 128.0
