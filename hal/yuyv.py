"""YUYV pictures from RGB ones and back, full-range BT.601 (as JPEG has it).

Source of the constants: ITU-T T.871, section 7.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_YUV_FROM_RGB = np.array(
    [
        [0.299, 0.587, 0.114],
        [-0.168735892, -0.331264108, 0.5],
        [0.5, -0.418687589, -0.081312411],
    ],
    dtype=np.float32,
)
_RGB_FROM_YUV = np.linalg.inv(_YUV_FROM_RGB.astype(np.float64)).astype(np.float32)


def yuv_from_rgb(rgb: NDArray[np.floating] | NDArray[np.uint8]) -> NDArray[np.float32]:
    """(..., 3) RGB, 0 to 255, to (..., 3) YUV, float32, U and V about 128; not clipped."""
    yuv = np.asarray(rgb, dtype=np.float32) @ _YUV_FROM_RGB.T
    yuv[..., 1:] += 128.0
    return yuv


def yuyv_from_rgb(rgb: NDArray[np.floating] | NDArray[np.uint8]) -> NDArray[np.uint8]:
    """(H, W, 3) RGB to (H, W, 2) YUYV, uint8; W must be even. Chroma is the mean of each pair."""
    yuv = yuv_from_rgb(rgb)
    height, width = yuv.shape[:2]
    if width % 2:
        raise ValueError(f"YUYV needs an even width, got {width}")
    chroma = yuv[..., 1:].reshape(height, width // 2, 2, 2).mean(axis=2)
    out = np.empty((height, width, 2), dtype=np.uint8)
    out[..., 0] = np.clip(np.rint(yuv[..., 0]), 0, 255)
    out[..., 1] = np.clip(np.rint(chroma), 0, 255).reshape(height, width)
    return out


def yuv_from_yuyv(yuyv: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """(H, W, 2) YUYV to (H, W, 3) YUV, uint8, chroma repeated."""
    height, width = yuyv.shape[:2]
    out = np.empty((height, width, 3), dtype=np.uint8)
    out[..., 0] = yuyv[..., 0]
    out[..., 1] = np.repeat(yuyv[:, 0::2, 1], 2, axis=1)
    out[..., 2] = np.repeat(yuyv[:, 1::2, 1], 2, axis=1)
    return out


def rgb_from_yuyv(yuyv: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """(H, W, 2) YUYV to (H, W, 3) RGB, uint8."""
    yuv = yuv_from_yuyv(yuyv).astype(np.float32)
    yuv[..., 1:] -= 128.0
    rgb = yuv @ _RGB_FROM_YUV.T
    return np.clip(np.rint(rgb), 0, 255).astype(np.uint8)
