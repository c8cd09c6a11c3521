"""Ours as the daemon runs it: model, energy's exact minimum, the regions that are the object."""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from naod.bench.peers.peer import STILL, Motion, Seen
from naod.config import SegmentationConfig
from naod.finding.find import find_object
from naod.finding.hue import Colours
from naod.geometry.camera import nominal_camera
from naod.perception.colour_model import Region
from naod.perception.learning import DEFAULT_KIND, ModelKind, learn_model
from naod.perception.segmenter import Segmenter
from naod.pose.objects import ObjectShape


class Ours:
    """The daemon's perception behind the interface."""

    def __init__(
        self,
        size: tuple[int, int],
        optimiser: str = "exact",
        kind: ModelKind = DEFAULT_KIND,
        shape: ObjectShape | None = None,
    ) -> None:
        self._size, self._kind, self._shape = size, kind, shape
        self._settings = msgspec.structs.replace(SegmentationConfig(), optimiser=optimiser)
        self._camera = nominal_camera("v6", *size)
        self._segmenter: Segmenter | None = None

    def learn(self, yuyv: NDArray[np.uint8], region: Region) -> None:
        """The colours, from one picture."""
        model = learn_model([yuyv], region, self._kind)
        self._segmenter = Segmenter(model, self._settings, self._size)

    def segment(self, yuyv: NDArray[np.uint8], motion_px: Motion = STILL) -> Seen:
        """Labels and the object's box."""
        assert self._segmenter is not None
        segmentation = self._segmenter.segment(yuyv)
        found = find_object(
            segmentation,
            self._shape,
            self._camera,
            None,
            self._settings,
            math.hypot(*motion_px),
            Colours(yuyv, self._segmenter.model),
        )
        corners = None if found is None else found.blob.corners_px
        return Seen(segmentation.mask, segmentation.scale, corners)
