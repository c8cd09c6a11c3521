"""Points followed by pyramidal Lucas-Kanade (OpenCV); the box moves as most of them do."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from naod.bench.peers.peer import STILL, Motion, Seen
from naod.perception.colour_model import Region

POINTS, POINTS_MIN = 60, 12
WINDOW_PX, LEVELS = 21, 4
MARKED_SHARE = 0.6


class LucasKanade:
    """Never looks at colours again; once lost it stays lost."""

    def __init__(self) -> None:
        self._before: NDArray[np.uint8] = np.zeros((1, 1), dtype=np.uint8)
        self._points: NDArray[np.float32] = np.zeros((0, 1, 2), dtype=np.float32)
        self._corners: NDArray[np.float64] | None = None

    def learn(self, yuyv: NDArray[np.uint8], region: Region) -> None:
        """The box around the region, and points in it."""
        middle = np.array([region.x + region.width / 2.0, region.y + region.height / 2.0])
        half = np.array([region.width, region.height]) / (2.0 * MARKED_SHARE)
        self._corners = middle + half * [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        self._before = np.ascontiguousarray(yuyv[..., 0])
        self._points = self._fresh_points()

    def segment(self, yuyv: NDArray[np.uint8], _motion_px: Motion = STILL) -> Seen:
        """Follow the points, move the box by the similarity that most agree on."""
        now = np.ascontiguousarray(yuyv[..., 0])
        T = self._movement(now)
        self._before = now
        mask = np.zeros(now.shape, dtype=np.uint8)
        if T is None or self._corners is None:
            self._corners, self._points = None, self._points[:0]
            return Seen(mask, 1.0, None)
        self._corners = self._corners @ T[:, :2].T + T[:, 2]
        if len(self._points) < POINTS_MIN:
            self._points = self._fresh_points()
        cv2.fillConvexPoly(mask, np.rint(self._corners).astype(np.int32), 1)
        return Seen(mask, 1.0, self._corners)

    def _movement(self, now: NDArray[np.uint8]) -> NDArray[np.float64] | None:
        """(2, 3) similarity from the last picture to this one; keeps the points that agree."""
        if len(self._points) < 3:
            return None
        points, good, _ = cv2.calcOpticalFlowPyrLK(
            self._before,
            now,
            self._points,
            np.empty_like(self._points),
            winSize=(WINDOW_PX, WINDOW_PX),
            maxLevel=LEVELS,
        )
        kept = good.ravel() == 1
        if np.count_nonzero(kept) < 3:
            return None
        before, after = self._points[kept], np.asarray(points, dtype=np.float32)[kept]
        T, agree = cv2.estimateAffinePartial2D(before, after)
        if T is None:
            return None
        self._points = after[agree.ravel() == 1]
        return np.asarray(T, dtype=np.float64)

    def _fresh_points(self) -> NDArray[np.float32]:
        assert self._corners is not None
        inside = np.zeros(self._before.shape, dtype=np.uint8)
        cv2.fillConvexPoly(inside, np.rint(self._corners).astype(np.int32), 255)
        points = cv2.goodFeaturesToTrack(self._before, POINTS, 0.01, 3, mask=inside)
        none = np.zeros((0, 1, 2), dtype=np.float32)
        return none if points is None else np.asarray(points, dtype=np.float32)


def make(_size: tuple[int, int]) -> LucasKanade:
    """For pictures of any size."""
    return LucasKanade()
