"""Whether the robot has fallen, and whether its feet feel the ground.

The thresholds are assumptions: no source gives one for standing. A NAO that leans further than
about 40 degrees is beyond its soles (0.1 m before the ankle, mass 0.27 m above it: 20 degrees) and
cannot come back.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hal.lola.sensors import Sensors

FALLEN_RAD, FALLEN_AFTER_S = 0.7, 0.12
UPRIGHT_RAD, UPRIGHT_AFTER_S = 0.4, 1.0
GRAVITY_TAU_S = 0.3
LIFTED_KG, LIFTED_AFTER_S = 0.7, 0.4
"""All eight cells together; the robot weighs 5.4 kg."""


@dataclass(frozen=True, slots=True)
class Balance:
    """`gravity_m_s2`: (3,), the accelerometer, smoothed. The times are how long it has been so."""

    fallen: bool
    lifted: bool
    gravity_m_s2: NDArray[np.float64]
    tilted_s: float = 0.0
    upright_s: float = 0.0
    light_s: float = 0.0


def begin(sensors: Sensors) -> Balance:
    """What the first message says."""
    state = Balance(False, _load_kg(sensors) < LIFTED_KG, sensors.accel_m_s2.copy())
    return Balance(_tilt_rad(state, sensors) > FALLEN_RAD, state.lifted, state.gravity_m_s2)


def step(state: Balance, sensors: Sensors, dt_s: float) -> Balance:
    """Move on by `dt_s`."""
    share = 1.0 - math.exp(-dt_s / GRAVITY_TAU_S)
    gravity = state.gravity_m_s2 + share * (sensors.accel_m_s2 - state.gravity_m_s2)
    moved = Balance(state.fallen, state.lifted, gravity)
    tilt = _tilt_rad(moved, sensors)
    tilted_s = state.tilted_s + dt_s if tilt > FALLEN_RAD else 0.0
    upright_s = state.upright_s + dt_s if tilt < UPRIGHT_RAD else 0.0
    light_s = state.light_s + dt_s if _load_kg(sensors) < LIFTED_KG else 0.0
    fallen = upright_s < UPRIGHT_AFTER_S if state.fallen else tilted_s >= FALLEN_AFTER_S
    return Balance(fallen, light_s >= LIFTED_AFTER_S, gravity, tilted_s, upright_s, light_s)


def _tilt_rad(state: Balance, sensors: Sensors) -> float:
    """The larger of what the inertial board's filter says and what gravity says."""
    roll, pitch = sensors.torso_roll_pitch_rad
    by_filter = math.acos(min(max(math.cos(float(roll)) * math.cos(float(pitch)), -1.0), 1.0))
    x, y, z = state.gravity_m_s2
    by_gravity = math.atan2(math.hypot(float(x), float(y)), float(z))
    return max(by_filter, by_gravity)


def _load_kg(sensors: Sensors) -> float:
    return float(sensors.fsr_kg.sum())
