"""GrabCut (Rother et al. 2004) by OpenCV, three iterations from a rectangle around the object.

`make` reduces pictures as ours does; `make_full` takes them whole.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from naod.bench.peers.peer import STILL, Motion, Seen
from naod.bench.peers.pictures import bgr_of, box_of
from naod.perception.colour_model import Region

ITERATIONS = 3
GROWN, MARGIN_SHARE = 1.3, 0.1
"""The rectangle over the last box, and a margin for a turning head, of the picture's width."""

BLOCK = 4
"""Pictures are reduced by it: at full size it would take seconds a frame."""

MARKED_SHARE = 0.6


class GrabCut:
    """Each rectangle is the last box grown; after a loss, all but the picture's rim."""

    def __init__(self, size: tuple[int, int], block: int) -> None:
        self._size, self._block = (size[0] // block, size[1] // block), block
        size = self._size
        self._rectangle = (1, 1, size[0] - 2, size[1] - 2)

    def learn(self, _yuyv: NDArray[np.uint8], region: Region) -> None:
        """It learns colours in every picture anew; only the place is kept."""
        x, y = region.x + region.width / 2.0, region.y + region.height / 2.0
        share = MARKED_SHARE * self._block
        middle = (x / self._block, y / self._block)
        self._around(middle, region.width / share, region.height / share)

    def segment(self, yuyv: NDArray[np.uint8], _motion_px: Motion = STILL) -> Seen:
        """Cut, box, and the next rectangle."""
        bgr = bgr_of(yuyv)
        if self._block > 1:
            width, height = self._size[0] * self._block, self._size[1] * self._block
            bgr = bgr[:height, :width]
            bgr = np.asarray(cv2.resize(bgr, self._size, interpolation=cv2.INTER_AREA))
        labels = np.zeros(bgr.shape[:2], dtype=np.uint8)
        back, fore = np.zeros((1, 65)), np.zeros((1, 65))
        cv2.grabCut(bgr, labels, self._rectangle, back, fore, ITERATIONS, cv2.GC_INIT_WITH_RECT)
        seen = box_of((labels & 1).astype(np.uint8), float(self._block))
        if seen.corners_px is None:
            self._rectangle = (1, 1, self._size[0] - 2, self._size[1] - 2)
        else:
            corners = seen.corners_px / self._block
            low, high = corners.min(axis=0), corners.max(axis=0)
            x, y = (low + high) / 2.0
            width, height = high - low
            self._around((float(x), float(y)), float(width), float(height))
        return seen

    def _around(self, middle: tuple[float, float], width: float, height: float) -> None:
        right, bottom = self._size
        width = GROWN * width + 2.0 * MARGIN_SHARE * right
        height = GROWN * height + 2.0 * MARGIN_SHARE * right
        left, top = middle[0] - width / 2.0, middle[1] - height / 2.0
        x, y = int(np.clip(left, 1, right - 3)), int(np.clip(top, 1, bottom - 3))
        self._rectangle = (
            x,
            y,
            int(np.clip(left + width - x, 2, right - 1 - x)),
            int(np.clip(top + height - y, 2, bottom - 1 - y)),
        )


def make(size: tuple[int, int]) -> GrabCut:
    """On pictures reduced by BLOCK."""
    return GrabCut(size, max(1, BLOCK * size[0] // 640))


def make_full(size: tuple[int, int]) -> GrabCut:
    """On whole pictures."""
    return GrabCut(size, 1)
