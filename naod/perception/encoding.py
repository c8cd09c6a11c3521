"""How a camera encodes light: levels are a curve of it, and pairs of pixels share their chroma."""

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


@njit(cache=True, nogil=True)
def light_of(level: float) -> float:
    """Light of a level, between the whole ones too."""
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
def _lights(yuv: NDArray[np.float64]) -> tuple[float, float, float]:
    """Light of red, green and blue of a colour Y, U, V (3,)."""
    u, v = yuv[1] - 128.0, yuv[2] - 128.0
    red = light_of(yuv[0] + 1.402 * v)
    green = light_of(yuv[0] - 0.344136 * u - 0.714136 * v)
    return red, green, light_of(yuv[0] + 1.772 * u)


@njit(cache=True, nogil=True)
def mixture_scores(
    inner: NDArray[np.float64],
    outer: NDArray[np.float64],
    direction: NDArray[np.float64],
    scores: NDArray[np.float64],
) -> None:
    """What mixtures of two colours look like along a direction: 0 for inner and 1 for outer.

    inner, outer, direction: (3,) Y, U, V. scores (n,): entry k is for a share k / (n - 1) of the
    outer colour's light.
    """
    a, b, last = _lights(inner), _lights(outer), scores.size - 1
    part = 1.0 / last
    wy, wu, wv = direction[0], direction[1], direction[2]
    from_red = 0.299 * wy - 0.168736 * wu + 0.5 * wv
    from_green = 0.587 * wy - 0.331264 * wu - 0.418688 * wv
    from_blue = 0.114 * wy + 0.5 * wu - 0.081312 * wv
    for k in range(last + 1):
        share = k * part
        scores[k] = from_red * level_of(a[0] + share * (b[0] - a[0]))
        scores[k] += from_green * level_of(a[1] + share * (b[1] - a[1]))
        scores[k] += from_blue * level_of(a[2] + share * (b[2] - a[2]))
    first, span = scores[0], scores[last] - scores[0]
    per_span = 1.0 / span if span > 0.0 else 0.0
    for k in range(last + 1):
        scores[k] = (scores[k] - first) * per_span if span > 0.0 else k * part
