"""YUYV conversion against OpenCV's JPEG-range conversion."""

import cv2
import numpy as np
import pytest

from hal.yuyv import rgb_from_yuyv, yuv_from_rgb, yuv_from_yuyv, yuyv_from_rgb


def test_yuv_equals_opencv_ycrcb():
    rgb = np.random.default_rng(0).integers(0, 256, (32, 48, 3), dtype=np.uint8)
    ycrcb = cv2.cvtColor(rgb, cv2.COLOR_RGB2YCrCb).astype(float)
    assert np.abs(yuv_from_rgb(rgb) - ycrcb[..., [0, 2, 1]]).max() <= 1.0


def test_round_trip_of_smooth_pictures():
    ramp = np.linspace(40, 200, 64, dtype=np.uint8)
    rgb = np.stack([np.tile(ramp, (16, 1)), np.full((16, 64), 90), np.full((16, 64), 60)], -1)
    back = rgb_from_yuyv(yuyv_from_rgb(rgb.astype(np.uint8))).astype(int)
    assert np.abs(back - rgb).max() <= 3


def test_chroma_is_shared_by_pairs():
    yuyv = np.zeros((1, 4, 2), np.uint8)
    yuyv[0, :, 0] = (1, 2, 3, 4)
    yuyv[0, :, 1] = (10, 20, 30, 40)
    yuv = yuv_from_yuyv(yuyv)[0]
    assert yuv.tolist() == [[1, 10, 20], [2, 10, 20], [3, 30, 40], [4, 30, 40]]


def test_odd_width_is_refused():
    with pytest.raises(ValueError, match="even"):
        yuyv_from_rgb(np.zeros((2, 3, 3), np.uint8))
