"""YUYV pictures of a sensor that is mounted upside down."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def upright(yuyv: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A YUYV picture (H, W, 2) uint8, W even, turned by 180 degrees, as a new array.

    Two pixels share one U and one V, the U beside the first and the V beside the second. Turned,
    the pair's pixels change places, and U and V do not.
    """
    height, width = yuyv.shape[:2]
    turned = np.empty_like(yuyv, order="C")
    turned[..., 0] = yuyv[::-1, ::-1, 0]
    chroma = yuyv[..., 1].reshape(height, width // 2, 2)
    turned[..., 1] = chroma[::-1, ::-1].reshape(height, width)
    return turned
