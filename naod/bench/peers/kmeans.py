"""k-means by OpenCV on every picture's colours; the cluster nearest to what was marked."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from naod.bench.peers.hsv import cut
from naod.bench.peers.peer import STILL, Motion, Seen
from naod.bench.peers.pictures import box_of
from naod.bench.peers.reduced import Reduced
from naod.perception.colour_model import Region

CLUSTERS = 8
LUMA_SHARE = 0.25
"""Weight of brightness: clusters of shades would leave none for a small object's colour."""

STOP = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 10, 1.0)
SEED = 1


class KMeans:
    """Unsupervised but for the choice among clusters."""

    def __init__(self, size: tuple[int, int]) -> None:
        self._reduced = Reduced(size)
        self._colour = np.zeros(3, dtype=np.float32)

    def learn(self, yuyv: NDArray[np.uint8], region: Region) -> None:
        """The mean colour of the region."""
        patch = cut(self._picture(yuyv), self._reduced.region(region))
        self._colour = patch.reshape(-1, 3).mean(axis=0)

    def segment(self, yuyv: NDArray[np.uint8], _motion_px: Motion = STILL) -> Seen:
        """Cluster, choose, box."""
        picture = self._picture(yuyv)
        cv2.setRNGSeed(SEED)
        _, labels, centres = cv2.kmeans(
            picture.reshape(-1, 3),
            CLUSTERS,
            np.empty(0, dtype=np.int32),
            STOP,
            1,
            cv2.KMEANS_PP_CENTERS,
        )
        chosen = int(np.argmin(np.linalg.norm(centres - self._colour, axis=1)))
        mask = (labels.reshape(picture.shape[:2]) == chosen).astype(np.uint8)
        return box_of(mask, float(self._reduced.block))

    def _picture(self, yuyv: NDArray[np.uint8]) -> NDArray[np.float32]:
        picture = self._reduced(yuyv)
        picture[..., 0] *= LUMA_SHARE
        return picture


def make(size: tuple[int, int]) -> KMeans:
    """For pictures of that size."""
    return KMeans(size)
