"""What most people write first: thresholds in HSV, opening and closing, the largest contour."""

from __future__ import annotations

from typing import TypeVar

import cv2
import numpy as np
from numpy.typing import NDArray

from naod.bench.peers.peer import STILL, Motion, Seen
from naod.bench.peers.pictures import box_of, hsv_of
from naod.perception.colour_model import Region

Level = TypeVar("Level", np.uint8, np.float32)

SHARES = (0.02, 0.98)
WIDER = (5.0, 40.0, 40.0)
"""Beyond the marked pixels' percentiles, in levels of hue, saturation, value."""

KERNEL_PX = 5


class HsvThreshold:
    """Thresholds come from the marked pixels; hue goes round."""

    def __init__(self) -> None:
        self._turn = 0
        self._lower = self._upper = np.zeros(3, dtype=np.uint8)
        self._kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (KERNEL_PX, KERNEL_PX))
        self._table = np.arange(256, dtype=np.uint8)

    def learn(self, yuyv: NDArray[np.uint8], region: Region) -> None:
        """Turn hue until the object's lies in the middle, then take percentiles."""
        patch = cut(hsv_of(yuyv), region).reshape(-1, 3)
        angles = patch[:, 0] * (np.pi / 90.0)
        mean = np.arctan2(np.sin(angles).mean(), np.cos(angles).mean()) * (90.0 / np.pi)
        self._turn = round(90.0 - mean) % 180
        self._table = ((np.arange(256) + self._turn) % 180).astype(np.uint8)
        turned = np.column_stack([self._table[patch[:, 0]], patch[:, 1:]])
        low, high = np.quantile(turned, SHARES, axis=0)
        self._lower = np.clip(low - WIDER, 0, 255).astype(np.uint8)
        self._upper = np.clip(high + WIDER, 0, 255).astype(np.uint8)

    def segment(self, yuyv: NDArray[np.uint8], _motion_px: Motion = STILL) -> Seen:
        """Threshold, open, close, largest contour."""
        hsv = hsv_of(yuyv)
        hsv[..., 0] = cv2.LUT(np.ascontiguousarray(hsv[..., 0]), self._table)
        mask = cv2.inRange(hsv, self._lower, self._upper)
        mask = cv2.morphologyEx(mask, cv2.MORPH_OPEN, self._kernel)
        mask = cv2.morphologyEx(mask, cv2.MORPH_CLOSE, self._kernel)
        return box_of(np.asarray(mask))


def cut(picture: NDArray[Level], region: Region) -> NDArray[Level]:
    """The region's part of a picture."""
    return picture[region.y : region.y + region.height, region.x : region.x + region.width]


def make(_size: tuple[int, int]) -> HsvThreshold:
    """For pictures of any size."""
    return HsvThreshold()
