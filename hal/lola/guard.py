"""The last thing before the wire: limits, speeds and stiffness hold whatever was wanted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hal.lola.sensors import Sensors
from hal.nao.ankle_limits import left_roll_range_rad, right_roll_range_rad
from hal.nao.head_limits import HEAD_SPEED_MAX_RAD_S, pitch_range_rad
from hal.nao.joints import JOINT_INDEX, JOINTS, LOWER_RAD, UPPER_RAD

Array = NDArray[np.float64]

STIFFEN_PER_S = 1.0
SOFTEN_PER_S = 1.0
LET_GO_PER_S = 4.0
"""Of full stiffness; letting go is for a robot that falls."""

_YAW, _PITCH = JOINT_INDEX["HeadYaw"], JOINT_INDEX["HeadPitch"]

_COUPLED: tuple[tuple[int, int, Callable[[float], tuple[float, float]]], ...] = (
    (_YAW, _PITCH, pitch_range_rad),
    (JOINT_INDEX["LAnklePitch"], JOINT_INDEX["LAnkleRoll"], left_roll_range_rad),
    (JOINT_INDEX["RAnklePitch"], JOINT_INDEX["RAnkleRoll"], right_roll_range_rad),
)
"""A joint, and the one whose range depends on it."""

_EXACT_RAD = 1e-9


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
    for leads, follows, range_rad in _COUPLED:
        low, high = range_rad(float(sent[leads]))
        before, value = float(state.angles_rad[follows]), float(sent[follows])
        change = min(max(value, low), high) - before
        sent[follows] = before + min(max(change, -reach[follows]), reach[follows])
        if not low - _EXACT_RAD <= sent[follows] <= high + _EXACT_RAD:
            # the range shrinks faster than the joint in it can go: the other one waits for it
            sent[leads] = state.angles_rad[leads]
    return GuardState(np.where(soft > 0.0, sent, sensors.angles_rad), soft)


def _finite(values: Array, instead: Array) -> Array:
    return np.where(np.isfinite(values), values, instead)


def _towards(now: Array, target: Array, most_down: Array | float, most_up: Array | float) -> Array:
    out: Array = now + np.clip(target - now, -np.asarray(most_down), np.asarray(most_up))
    return out
