"""From the gait to the whole body: torso and joint angles that put the soles where they belong."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hal.nao.joints import JOINT_INDEX
from sim_backend.figures import standing_angles, standing_torso
from sim_backend.gait import Gait
from sim_backend.legs import FIRST_LEFT, FIRST_RIGHT, solve_legs
from sim_backend.motions import (
    BOB_M,
    PITCH_RAD,
    ROLL_RAD,
    STEP_HEIGHT_M,
    SWAY_M,
    nod,
    support_share,
    swing,
)
from sim_backend.poses import (
    Matrix,
    Pose,
    between,
    compose,
    midway,
    mixed,
    moved,
    planar,
    rot_x,
    rot_y,
    rot_z,
    transform,
)

ARM_SWING_RAD_PER_M = 3.0
_STANDING = np.array(standing_angles())
_T_BASE_TORSO = standing_torso()
_SHOULDERS = (JOINT_INDEX["LShoulderPitch"], JOINT_INDEX["RShoulderPitch"])

Sole = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Posed:
    """A body in the odometry frame.

    `T_odom_torso` (4, 4); `angles_rad` (26,), head zero; `base` between the soles; `load_left` is
    the left foot's share of the weight.
    """

    T_odom_torso: Matrix
    angles_rad: NDArray[np.float64]
    base: Pose
    load_left: float


def posed(gait: Gait) -> Posed:
    """The body that goes with a state of the gait."""
    left, right = soles(gait)
    T_odom_torso = _torso(gait)
    legs, yaw, _ = solve_legs(T_odom_torso, np.array(left), np.array(right))
    T_odom_torso[:3, :3] = rot_z(yaw) @ T_odom_torso[:3, :3]
    angles = _STANDING.copy()
    angles[FIRST_LEFT : FIRST_LEFT + 6] = legs[:6]
    angles[FIRST_RIGHT : FIRST_RIGHT + 6] = legs[6:]
    on_floor = (left[0], left[1], left[3]), (right[0], right[1], right[3])
    base = midway(*on_floor)
    for shoulder, foot in zip(_SHOULDERS, on_floor, strict=True):
        angles[shoulder] += ARM_SWING_RAD_PER_M * between(base, foot)[0]
    return Posed(T_odom_torso, angles, base, _load_left(gait))


def soles(gait: Gait) -> tuple[Sole, Sole]:
    """Left and right sole: x, y, height and yaw in the odometry frame."""
    found: dict[int, Sole] = {
        side: (foot[0], foot[1], 0.0, foot[2]) for side, foot in gait.feet.items()
    }
    step = gait.step
    if step is not None:
        share, lift = swing(gait.elapsed_s)
        x, y, yaw = mixed(gait.feet[step.side], step.lands, share)
        found[step.side] = (x, y, STEP_HEIGHT_M * lift, yaw)
    return found[1], found[-1]


def _torso(gait: Gait) -> Matrix:
    sway, _ = gait.sway.at(gait.elapsed_s)
    inner = nod(gait.elapsed_s) if gait.step is not None else 0.0
    lean = rot_x(-ROLL_RAD * sway / SWAY_M) @ rot_y(PITCH_RAD * inner)
    T_base = planar(compose(gait.reference(), (0.0, sway, 0.0))) @ moved(0.0, 0.0, -BOB_M * inner)
    T_odom_torso = T_base @ _T_BASE_TORSO
    T_odom_torso[:3, :3] = T_base[:3, :3] @ lean @ _T_BASE_TORSO[:3, :3]
    return transform(T_odom_torso[:3, :3], T_odom_torso[:3, 3])


def _load_left(gait: Gait) -> float:
    if gait.step is None:
        return 0.5
    share = support_share(gait.elapsed_s)
    return share if gait.step.side < 0 else 1.0 - share
