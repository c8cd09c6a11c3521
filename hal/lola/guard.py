"""The last thing before the wire: limits, speeds and stiffness hold whatever was wanted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hal.lola.sensors import Sensors
from hal.nao.head_limits import HEAD_SPEED_MAX_RAD_S, YAW_MAX_RAD, pitch_range_rad
from hal.nao.joints import JOINT_INDEX, JOINTS, LOWER_RAD, UPPER_RAD

Array = NDArray[np.float64]

STIFFEN_PER_S = 1.0
SOFTEN_PER_S = 1.0
LET_GO_PER_S = 4.0
"""Of full stiffness; letting go is for a robot that falls."""

_YAW, _PITCH = JOINT_INDEX["HeadYaw"], JOINT_INDEX["HeadPitch"]


def _speeds() -> Array:
    speeds = np.array([joint.speed_max_rad_s for joint in JOINTS])
    speeds[_YAW], speeds[_PITCH] = HEAD_SPEED_MAX_RAD_S
    return speeds


SPEED_MAX_RAD_S: Array = _speeds()


@dataclass(frozen=True, slots=True)
class GuardState:
    """What was sent last, (26,) each."""

    angles_rad: Array
    stiffness: Array


def begin(sensors: Sensors) -> GuardState:
    """The joints stay where they are, as stiff as they are."""
    return GuardState(sensors.angles_rad.copy(), np.clip(sensors.stiffness, 0.0, 1.0))


def step(
    state: GuardState,
    sensors: Sensors,
    angles_rad: Array,
    stiffness: Array,
    dt_s: float,
    soften_per_s: float = SOFTEN_PER_S,
) -> GuardState:
    """What may be sent of what is wanted, (26,) each.

    A number that is not finite leaves its joint as it was. A joint that is not stiff has the
    measured angle for a target, so that it does not jump when it is stiffened.
    """
    soft = _towards(
        state.stiffness,
        np.clip(_finite(stiffness, state.stiffness), 0.0, 1.0),
        soften_per_s * dt_s,
        STIFFEN_PER_S * dt_s,
    )
    wanted = np.clip(_finite(angles_rad, state.angles_rad), LOWER_RAD, UPPER_RAD)
    reach = SPEED_MAX_RAD_S * dt_s
    sent = _towards(state.angles_rad, wanted, reach, reach)
    yaw = min(max(float(sent[_YAW]), -YAW_MAX_RAD), YAW_MAX_RAD)
    low, high = pitch_range_rad(yaw)
    pitch = min(max(float(sent[_PITCH]), low), high)
    before = float(state.angles_rad[_PITCH])
    sent[_PITCH] = before + min(max(pitch - before, -reach[_PITCH]), reach[_PITCH])
    return GuardState(np.where(soft > 0.0, sent, sensors.angles_rad), soft)


def _finite(values: Array, instead: Array) -> Array:
    return np.where(np.isfinite(values), values, instead)


def _towards(now: Array, target: Array, most_down: Array | float, most_up: Array | float) -> Array:
    out: Array = now + np.clip(target - now, -np.asarray(most_down), np.asarray(most_up))
    return out
