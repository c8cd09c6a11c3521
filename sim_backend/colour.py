"""sRGB levels and linear light (IEC 61966-2-1)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_ENTRIES = 8192


def linear_from_srgb(levels: NDArray[np.floating] | NDArray[np.uint8]) -> NDArray[np.float64]:
    """Levels 0 to 255, any shape, to linear light 0 to 1."""
    share = np.asarray(levels, dtype=np.float64) / 255.0
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def srgb_from_linear(light: NDArray[np.floating]) -> NDArray[np.float64]:
    """Linear light, clipped to 0 to 1, to levels 0 to 255, not rounded."""
    share = np.clip(np.asarray(light, dtype=np.float64), 0.0, 1.0)
    return 255.0 * np.where(share <= 0.0031308, 12.92 * share, 1.055 * share ** (1.0 / 2.4) - 0.055)


LEVELS: NDArray[np.float32] = srgb_from_linear(np.linspace(0.0, 1.0, _ENTRIES)).astype(np.float32)
"""sRGB levels of equally spaced linear light, for a quick look-up."""
