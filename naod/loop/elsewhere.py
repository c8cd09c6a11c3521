"""Whether to believe a sighting elsewhere than where the object is expected.

Things of its colour, shape and size are found as soon as the head is turned away from it. They are
not it as long as it may still be where it was; that place is looked at first.
"""

from __future__ import annotations

import math

import numpy as np

from naod.gaze.search import FIRST_S
from naod.loop.equipment import Equipment, Sighting
from naod.loop.state import LoopState
from naod.pose.contour import figures
from naod.pose.prior import Prior

SIGMAS = 4.0
MARGIN = 0.1
"""Share of the picture, at each side, where an object in view may be cut off."""

NEAREST_M = 0.05


def believed(
    equipment: Equipment, state: LoopState, sighting: Sighting | None, now_ns: int
) -> Sighting | None:
    """The sighting, or None while the place where the object is expected was not looked at."""
    if sighting is None or sighting.expected is None:
        return sighting
    searching_ns = 0 if state.search_from_ns is None else now_ns - state.search_from_ns
    if searching_ns >= FIRST_S * 1e9 or is_there(equipment, sighting, sighting.expected):
        return sighting
    return sighting if _is_in_view(equipment, sighting.expected) else None


def is_there(equipment: Equipment, sighting: Sighting, expected: Prior) -> bool:
    """Whether it is where it is expected, by an object's length and what is not known of both."""
    at, pose = expected.T_camera_object[:3, 3], sighting.pose
    covariance = expected.covariance[:3, :3]
    if pose is None or pose.clipped:
        # how far away it is is not known: what counts is how far its ray passes the place
        ray = sighting.ray_in_camera / np.linalg.norm(sighting.ray_in_camera)
        gap_m = float(np.linalg.norm(at - max(float(at @ ray), 0.0) * ray))
    else:
        gap_m = float(np.linalg.norm(at - pose.T_camera_object[:3, 3]))
        covariance = covariance + pose.covariance[:3, :3]
    _, half_width, half_height = figures(equipment.shape)
    size_m = 2.0 * max(half_width, half_height)
    return gap_m <= size_m + SIGMAS * math.sqrt(float(np.linalg.eigvalsh(covariance)[-1]))


def _is_in_view(equipment: Equipment, expected: Prior) -> bool:
    x, y, z = (float(value) for value in expected.T_camera_object[:3, 3])
    if z < NEAREST_M:
        return False
    camera = equipment.camera
    column = (camera.fx * x / z + camera.cx) / camera.width
    row = (camera.fy * y / z + camera.cy) / camera.height
    return MARGIN <= column <= 1.0 - MARGIN and MARGIN <= row <= 1.0 - MARGIN
