"""Where the object is to be expected in a picture: its last place, carried on by odometry."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hal.types import PlanarMotion
from naod.geometry.transforms import Matrix, inverse, planar, yaw_of
from naod.localisation.camera_motion import CameraMotion
from naod.localisation.placement import Placement, both, lateness, turned
from naod.messages import WalkState
from naod.pose.frames import facing
from naod.pose.prior import Prior

ODOMETRY_SHARE = 0.2
"""Of the way and of the turn: published scales of a NAO's odometry go from 0.85 to 1.23
(`walk_facts.yaml`)."""

VEER_RAD_PER_M = 0.2
SWAY_M, SWAY_RAD = 0.02, 0.03
"""Of the base frame between the feet while they walk."""

CARRIED_M_SQRT_S, TURNED_RAD_SQRT_S = 0.01, 0.02
"""Somebody may move the object; per square root of a second."""

CLOCK_S = 0.01
"""Between the time of a picture and that of the angles."""

LATE_S = 0.1
"""Odometry is from another moment than the picture by up to so much."""

UNSURE_M = 0.5
"""Less sure of its place than this, nothing is expected."""


@dataclass(frozen=True, slots=True)
class Anchor:
    """Where the object was seen last, and the odometry at that time."""

    stamp_ns: int
    T_base_object: Matrix
    covariance: NDArray[np.float64]
    odometry: tuple[float, float, float]


def anchored(placement: Placement, walk: WalkState) -> Anchor:
    """What is to be remembered of a placement."""
    total = placement.own + placement.shared
    return Anchor(placement.stamp_ns, placement.T_base_object, total, walk.odometry)


def carried_on(prior: Prior, T_base_camera: Matrix, stamp_ns: int, walk: WalkState) -> Anchor:
    """What is to be remembered where the object was seen as expected, but not better known."""
    R = both(T_base_camera[:3, :3])
    T_base_object = T_base_camera @ prior.T_camera_object
    return Anchor(stamp_ns, T_base_object, R @ prior.covariance @ R.T, walk.odometry)


def expected(
    anchor: Anchor,
    walk: WalkState,
    T_base_camera: Matrix,
    stamp_ns: int,
    turns_to_us: bool,
    motion: CameraMotion | None = None,
) -> Prior | None:
    """The object in the camera at a time, None when that is no longer known to half a metre.

    `turns_to_us`: its z axis looks towards the camera from wherever it is seen, as a can's does.
    `motion`: of the camera at that time, by which the clocks' error counts.
    """
    age_s = max(stamp_ns - anchor.stamp_ns, 0) / 1e9
    T_then_now = inverse(planar(*anchor.odometry)) @ planar(*walk.odometry)
    T_now_then = inverse(T_then_now)
    T_base_object = T_now_then @ anchor.T_base_object
    R = both(T_now_then[:3, :3])
    gone = PlanarMotion(float(T_then_now[0, 3]), float(T_then_now[1, 3]), yaw_of(T_then_now))
    covariance = R @ anchor.covariance @ R.T
    covariance = covariance + _growth(T_base_object[:3, 3], gone, walk, age_s)
    if motion is not None:
        late = lateness(T_base_object[:3, 3], T_base_camera, motion)
        covariance = covariance + CLOCK_S**2 * np.outer(late, late)
    if not np.isfinite(covariance).all() or np.trace(covariance[:3, :3]) > UNSURE_M**2:
        return None
    T = inverse(T_base_camera) @ T_base_object
    if turns_to_us:
        T[:3, :3] = facing(T[:3, 1], T[:3, 3])
    into = both(T_base_camera[:3, :3].T)
    return Prior(T, into @ covariance @ into.T, age_s)


def _growth(
    at: NDArray[np.float64], gone: PlanarMotion, walk: WalkState, age_s: float
) -> NDArray[np.float64]:
    """(6, 6) along the base's axes: what a way, a turn and the time since add."""
    way, turn = math.hypot(gone.x, gone.y), abs(gone.yaw)
    speed = math.hypot(walk.velocity[0], walk.velocity[1])
    slip = (ODOMETRY_SHARE * way) ** 2 + (LATE_S * speed) ** 2
    veer = (ODOMETRY_SHARE * turn) ** 2 + (VEER_RAD_PER_M * way) ** 2
    veer += (LATE_S * walk.velocity[2]) ** 2
    sway_m, sway_rad = (SWAY_M, SWAY_RAD) if walk.moving else (0.0, 0.0)
    arm = turned(at)
    about = np.diag([sway_rad**2, sway_rad**2, sway_rad**2 + veer])
    own = CARRIED_M_SQRT_S**2 * age_s + sway_m**2
    turns = TURNED_RAD_SQRT_S**2 * age_s
    straight = np.diag([own + slip, own + slip, own, turns, turns, turns])
    return np.asarray(straight + arm @ about @ arm.T, dtype=np.float64)
