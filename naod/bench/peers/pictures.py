"""What several peers need: a camera's picture as OpenCV takes it, and a mask's box."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from naod.bench.peers.peer import Seen

AREA_MIN_SHARE = 0.0005
"""Of the picture: below it, a region is nothing. A can 1.5 m away has 0.0045."""


def bgr_of(yuyv: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """(H, W, 3) BGR by OpenCV's own conversion, which is the quick one.

    It takes the picture for video range; colours shift a little, learning and seeing alike.
    """
    return np.asarray(cv2.cvtColor(yuyv, cv2.COLOR_YUV2BGR_YUYV))


def hsv_of(yuyv: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """(H, W, 3) HSV, hue 0 to 179."""
    return np.asarray(cv2.cvtColor(bgr_of(yuyv), cv2.COLOR_BGR2HSV))


def box_of(mask: NDArray[np.uint8], grain_px: float = 1.0) -> Seen:
    """The largest region's oriented box, by OpenCV's contours."""
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)
    largest = max(contours, key=cv2.contourArea, default=None)
    if largest is None or cv2.contourArea(largest) < AREA_MIN_SHARE * mask.size:
        return Seen(mask, grain_px, None)
    middle, (width, height), angle = cv2.minAreaRect(largest)
    # OpenCV's goes through the centres of the outermost pixels
    box = (middle, (width + 1.0, height + 1.0), angle)
    corners = np.asarray(cv2.boxPoints(box), dtype=np.float64)
    return Seen(mask, grain_px, (corners + 0.5) * grain_px - 0.5)
