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
from naod.geometry.camera import PinholeCamera, nominal_camera
from naod.perception.blob import Blob, oriented_box
from naod.perception.colour_model import Region
from naod.perception.learning import DEFAULT_KIND, ModelKind, learn_model
from naod.perception.segmenter import Segmenter
from naod.pose.contour import outline_px
from naod.pose.locate import locate
from naod.pose.objects import ObjectShape


class Ours:
    """The daemon's perception behind the interface."""

    def __init__(
        self,
        size: tuple[int, int],
        optimiser: str = "exact",
        kind: ModelKind = DEFAULT_KIND,
        shape: ObjectShape | None = None,
        by_edges: bool = False,
    ) -> None:
        """by_edges: the box is that of the pose that the picture's edges give."""
        self._size, self._kind, self._shape = size, kind, shape
        self._by_edges = by_edges
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
        if found is not None and self._by_edges and self._shape is not None:
            corners = _box_by_edges(yuyv, found.blob, self._shape, self._camera)
        return Seen(segmentation.mask, segmentation.scale, corners)


def _box_by_edges(
    yuyv: NDArray[np.uint8], blob: Blob, shape: ObjectShape, camera: PinholeCamera
) -> NDArray[np.float64]:
    """The smallest rectangle around the outline of the pose; the blob's where there is none."""
    pose = locate(yuyv, blob, shape, camera)
    if pose is None:
        return blob.corners_px
    return oriented_box(outline_px(shape, pose.T_camera_object, camera))
