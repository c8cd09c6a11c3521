"""CAMShift (Bradski 1998) by OpenCV: a hue histogram's back-projection, climbed by a window."""

from __future__ import annotations

from collections.abc import Sequence as SequenceOf

import cv2
import numpy as np
from numpy.typing import NDArray

from naod.bench.peers.hsv import cut
from naod.bench.peers.peer import STILL, Motion, Seen
from naod.bench.peers.pictures import hsv_of
from naod.perception.colour_model import Region

BINS = 32
SATURATION_MIN, VALUE_MIN = 60, 32
"""Below them hue is noise (OpenCV's own camshift sample)."""

LIKELY = 64
MARGIN_SHARE = 0.05
"""Of the picture's width, that the window is grown by at each side: the head may have turned."""

STOP = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 10, 1.0)


class CamShift:
    """Follows from picture to picture; a window that shrank to nothing starts from everywhere."""

    def __init__(self) -> None:
        self._histogram: NDArray[np.float32] = np.zeros((BINS, 1), dtype=np.float32)
        self._window: SequenceOf[int] = (0, 0, 1, 1)

    def learn(self, yuyv: NDArray[np.uint8], region: Region) -> None:
        """Histogram of the region's hue; the window begins there."""
        patch = np.ascontiguousarray(cut(hsv_of(yuyv), region))
        self._histogram = np.asarray(
            cv2.calcHist([patch], [0], _coloured(patch), [BINS], [0, 180]), dtype=np.float32
        )
        cv2.normalize(self._histogram, self._histogram, 0, 255, cv2.NORM_MINMAX)
        self._window = (region.x, region.y, region.width, region.height)

    def segment(self, yuyv: NDArray[np.uint8], _motion_px: Motion = STILL) -> Seen:
        """Climb; the mask is what is likely within the box."""
        hsv = hsv_of(yuyv)
        likely = cv2.calcBackProject([hsv], [0], self._histogram, [0, 180], 1)
        # faint likeness all over a wooden table would swell the window to the whole picture
        _, likely = cv2.threshold(likely, LIKELY - 1, 0, cv2.THRESH_TOZERO)
        likely = cv2.bitwise_and(likely, _coloured(hsv))
        height, width = yuyv.shape[:2]
        box, window = cv2.CamShift(likely, _grown(self._window, width, height), STOP)
        self._window = window
        if min(window[2:]) <= 1 or min(box[1]) <= 1.0:
            self._window = (0, 0, width, height)
            return Seen(np.zeros((height, width), dtype=np.uint8), 1.0, None)
        corners = np.asarray(cv2.boxPoints(box), dtype=np.float64)
        inside = np.zeros((height, width), dtype=np.uint8)
        cv2.fillConvexPoly(inside, np.rint(corners).astype(np.int32), 255)
        return Seen(inside & np.asarray(likely, dtype=np.uint8), 1.0, corners)


def _grown(window: SequenceOf[int], width: int, height: int) -> tuple[int, int, int, int]:
    margin = round(MARGIN_SHARE * width)
    x, y = max(window[0] - margin, 0), max(window[1] - margin, 0)
    right, bottom = window[0] + window[2] + margin, window[1] + window[3] + margin
    return x, y, min(right, width) - x, min(bottom, height) - y


def _coloured(hsv: NDArray[np.uint8]) -> NDArray[np.uint8]:
    return np.asarray(cv2.inRange(hsv, (0, SATURATION_MIN, VALUE_MIN), (180, 255, 255)))


def make(_size: tuple[int, int]) -> CamShift:
    """For pictures of any size."""
    return CamShift()
