"""Ours as the daemon runs it: one Gaussian, reduced picture, the energy's exact minimum."""

from __future__ import annotations

import msgspec
import numpy as np
from numpy.typing import NDArray

from naod.bench.peers.peer import STILL, Motion, Seen
from naod.config import SegmentationConfig
from naod.perception.blob import find_blob
from naod.perception.colour_model import ColourModel, Region, learn
from naod.perception.segmenter import Segmenter


class Ours:
    """The segmenter of `naod.perception` behind the interface."""

    def __init__(self, size: tuple[int, int], settings: SegmentationConfig) -> None:
        self._size, self._settings = size, settings
        self._segmenter: Segmenter | None = None

    def learn(self, yuyv: NDArray[np.uint8], region: Region) -> None:
        """One Gaussian of the region."""
        self.use(learn([yuyv], region))

    def use(self, model: ColourModel) -> None:
        """Take the colour as learnt by somebody else."""
        self._segmenter = Segmenter(model, self._settings, self._size)

    def segment(self, yuyv: NDArray[np.uint8], _motion_px: Motion = STILL) -> Seen:
        """Labels and the largest region's box."""
        assert self._segmenter is not None
        segmentation = self._segmenter.segment(yuyv)
        blob = find_blob(segmentation, self._settings.pixels_min)
        corners = None if blob is None else blob.corners_px
        return Seen(segmentation.mask, segmentation.scale, corners)


def make(size: tuple[int, int], optimiser: str = "exact") -> Ours:
    """With the daemon's own settings."""
    return Ours(size, msgspec.structs.replace(SegmentationConfig(), optimiser=optimiser))
