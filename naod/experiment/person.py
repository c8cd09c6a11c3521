"""What a person does in the experiment: points the head, marks the object in the picture."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hal.simulation import Truth
from hal.types import HeadAngles
from naod.errors import InputError
from naod.experiment.lockstep import LockStep
from naod.gaze.centring import head_towards
from naod.geometry.camera import PinholeCamera
from naod.geometry.transforms import inverse
from naod.loop.equipment import head_angles
from naod.loop.types import Label
from naod.pose.objects import Cylinder, ObjectShape

# share of the object's extent that is marked: well inside, so that no background is learnt
_MARKED = 0.6
_POINTINGS = 3


def point_head(run: LockStep) -> None:
    """Turn the head until the object is in the middle of the picture."""
    for _ in range(_POINTINGS):
        body = run.robot.body.latest()
        frames = run.equipment.body.frames(body.angles_rad)
        ray = _object_in_camera(run.robot.truth())
        now = head_angles(body)
        target = head_towards(ray, frames.T_torso_camera, now, run.equipment.camera_name, 1.0)
        run.look(HeadAngles(target.yaw_rad, target.pitch_rad), wait_s=0.6)


def mark(truth: Truth, shape: ObjectShape, camera: PinholeCamera) -> Label:
    """The region a person would draw on the object. Raises InputError if it is out of view."""
    T = inverse(truth.T_world_camera) @ truth.T_world_object
    corners = face_corners(shape) * (_MARKED, _MARKED, 1.0)
    points = (T[:3, :3] @ corners.T).T + T[:3, 3]
    if points[:, 2].min() <= 0.05:
        raise InputError("the object cannot be seen from where the goal is to be demonstrated")
    pixels = camera.project(points)
    # the largest upright box inside the four corners
    left, right = sorted(pixels[:, 0])[1:3]
    top, bottom = sorted(pixels[:, 1])[1:3]
    x, y = math.ceil(max(left, 0.0)), math.ceil(max(top, 0.0))
    width = math.floor(min(right, camera.width - 1)) - x
    height = math.floor(min(bottom, camera.height - 1)) - y
    if width < 4 or height < 4:
        raise InputError("the object cannot be seen from where the goal is to be demonstrated")
    return Label(x, y, width, height)


def face_corners(shape: ObjectShape) -> NDArray[np.float64]:
    """(4, 3) corners of the side that is seen, in the object's frame, metres."""
    if isinstance(shape, Cylinder):
        x, y, z = shape.radius_m, 0.5 * shape.height_m, shape.radius_m
        return np.array([[-x, y, z], [x, y, z], [x, -y, z], [-x, -y, z]]) * (0.9, 1.0, 0.3)
    x, y = 0.5 * shape.width_m, 0.5 * shape.height_m
    return np.array([[-x, y, 0.0], [x, y, 0.0], [x, -y, 0.0], [-x, -y, 0.0]])


def _object_in_camera(truth: Truth) -> NDArray[np.float64]:
    place: NDArray[np.float64] = (inverse(truth.T_world_camera) @ truth.T_world_object)[:3, 3]
    return place
