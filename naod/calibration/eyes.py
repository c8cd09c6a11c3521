"""Finding the rectangle in a picture and measuring its edges."""

from __future__ import annotations

from dataclasses import dataclass

from hal.types import Frame
from naod.calibration.view import EdgePoints, measured_edges
from naod.config import DaemonConfig
from naod.geometry.camera import PinholeCamera
from naod.geometry.transforms import Matrix
from naod.perception.blob import find_blob
from naod.perception.colour_model import ColourModel
from naod.perception.segmenter import Segmenter
from naod.pose.locate import locate
from naod.pose.objects import Rectangle


@dataclass(frozen=True, slots=True)
class Glimpse:
    """The rectangle in one picture."""

    edges: EdgePoints
    T_camera_object: Matrix


class Eyes:
    """What looks at the pictures: colour, size of the rectangle, and the camera so far."""

    def __init__(
        self, config: DaemonConfig, model: ColourModel, shape: Rectangle, camera: PinholeCamera
    ) -> None:
        size = (camera.width, camera.height)
        self._segmenter = Segmenter(model, config.segmentation, size)
        self._pixels_min = config.segmentation.pixels_min
        self.shape, self.camera = shape, camera

    def glimpse(self, frame: Frame) -> tuple[Glimpse | None, str]:
        """The rectangle, or None and why there is none."""
        blob = find_blob(self._segmenter.segment(frame.yuyv), self._pixels_min)
        if blob is None:
            return None, "nothing of its colour is in view"
        if blob.clipped:
            return None, f"it is cut off at the {' and '.join(blob.clipped)}"
        pose = locate(frame.yuyv, blob, self.shape, self.camera, exposure_s=frame.exposure_s)
        if pose is None:
            return None, "what has its colour has not its outline"
        edges = measured_edges(frame.yuyv, pose, self.shape, self.camera)
        if edges is None:
            return None, "an edge of it cannot be made out"
        return Glimpse(edges, pose.T_camera_object), ""
