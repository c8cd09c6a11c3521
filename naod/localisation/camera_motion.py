"""How the camera moves at the time of a picture, from the joints, the gyroscope and the walk."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hal.types import BodyState, PlanarMotion
from naod.geometry.camera import PinholeCamera
from naod.geometry.transforms import Matrix, Vector
from naod.localisation.base_frame import T_torso_base
from naod.localisation.body_model import BodyModel

STANDING = PlanarMotion(0.0, 0.0, 0.0)

AHEAD_MIN_M = 0.05
"""Nearer to the camera's plane than this nothing is in the picture."""


@dataclass(frozen=True, slots=True)
class CameraMotion:
    """Of the camera in the room, along its own axes (x right, y down, z forward).

    `velocity_m_s`: (3,). `turn_rad_s`: (3,), right-handed about each axis.
    """

    velocity_m_s: Vector
    turn_rad_s: Vector


def camera_motion(
    model: BodyModel, before: BodyState, after: BodyState, walking: PlanarMotion = STANDING
) -> CameraMotion | None:
    """The mean motion between two states of the body; None if no time has passed between them.

    The torso turns as its gyroscope says, about the place between the feet, and goes along with
    the walk's velocity (m/s in the base frame; its turn is the gyroscope's affair).
    """
    span_s = (after.stamp_ns - before.stamp_ns) / 1e9
    if span_s <= 0.0:
        return None
    first, last = model.frames(before.angles_rad), model.frames(after.angles_rad)
    T_torso_camera = first.T_torso_camera
    R_torso_camera = T_torso_camera[:3, :3]
    R_turn = last.T_torso_camera[:3, :3] @ R_torso_camera.T
    gyro = 0.5 * (before.gyro_rad_s + after.gyro_rad_s)
    T_base = T_torso_base(last, after.foot_load_kg)
    velocity = (last.T_torso_camera[:3, 3] - T_torso_camera[:3, 3]) / span_s
    velocity = velocity + np.cross(gyro, T_torso_camera[:3, 3] - T_base[:3, 3])
    velocity = velocity + T_base[:3, :3] @ (walking.x, walking.y, 0.0)
    turn = gyro + rotation_vector(R_turn) / span_s
    return CameraMotion(R_torso_camera.T @ velocity, R_torso_camera.T @ turn)


def motion_px(
    motion: CameraMotion, point_in_camera: Vector, camera: PinholeCamera, time_s: float
) -> tuple[float, float]:
    """How far a point that stands in the room moves through the picture, px right and down.

    point_in_camera: (3,) in m, where it is in the middle of `time_s`. Nothing for a point that is
    not before the camera.
    """
    gone = -(motion.velocity_m_s + np.cross(motion.turn_rad_s, point_in_camera)) * time_s
    ends = np.stack([point_in_camera - 0.5 * gone, point_in_camera + 0.5 * gone])
    if ends[:, 2].min() < AHEAD_MIN_M:
        return 0.0, 0.0
    pixels = camera.project(ends)
    return float(pixels[1, 0] - pixels[0, 0]), float(pixels[1, 1] - pixels[0, 1])


def rotation_vector(R: Matrix) -> Vector:
    """Axis times angle, (3,), of a rotation (3, 3) by less than half a turn."""
    vee = 0.5 * np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    sine = float(np.linalg.norm(vee))
    if sine < 1e-9:
        return vee
    angle = math.atan2(sine, 0.5 * (float(np.trace(R)) - 1.0))
    return np.asarray(vee * (angle / sine), dtype=np.float64)
