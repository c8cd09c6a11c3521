"""Where the search for a pose starts.

A single outline leaves a sign open that only perspective decides (a can tilted towards the viewer
or away, a board turned left or right), so there are always several starts.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from naod.geometry.camera import PinholeCamera
from naod.perception.blob import ordered_corners, oriented_box
from naod.pose.box import Box
from naod.pose.cylinder_starts import first_cylinder_starts, next_cylinder_starts
from naod.pose.objects import Cylinder, ObjectShape
from naod.pose.outline import Outline
from naod.pose.rectangle_starts import clipped_rectangle_starts, mirrored, rectangle_starts


def first_starts(
    outline: Outline, shape: ObjectShape, camera: PinholeCamera
) -> list[NDArray[np.float64]]:
    """Poses (4, 4) to start from when nothing but an outline is known."""
    corners = oriented_box(outline.points_px)
    box = Box(camera.normalised(corners), _cut(outline, corners, camera))
    if isinstance(shape, Cylinder):
        return first_cylinder_starts(shape, box, camera.normalised(outline.points_px))
    found = []
    if not outline.clipped:
        four = np.asarray(cv2.approxPolyN(outline.points_px.astype(np.float32), 4)).reshape(-1, 2)
        if len(four) == 4:
            quadrilateral = ordered_corners(four.astype(np.float64))
            found = rectangle_starts(shape, camera.normalised(quadrilateral))
    return found or clipped_rectangle_starts(shape, box)


def next_starts(shape: ObjectShape, T: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """A pose found and its other readings, to start again from on better edges."""
    return next_cylinder_starts(T) if isinstance(shape, Cylinder) else [T, mirrored(T)]


def _cut(
    outline: Outline, corners: NDArray[np.float64], camera: PinholeCamera
) -> NDArray[np.bool_]:
    """Which edges of a box (4, 2) in pixels are the picture's border."""
    middles = (corners + np.roll(corners, -1, axis=0)) / 2.0
    slack = 2.0 * outline.grain_px + 2.0
    near = {
        "left": middles[:, 0] < slack,
        "right": middles[:, 0] > camera.width - 1 - slack,
        "top": middles[:, 1] < slack,
        "bottom": middles[:, 1] > camera.height - 1 - slack,
    }
    cut = np.zeros(4, dtype=np.bool_)
    for side in outline.clipped:
        cut |= near[side]
    return cut
