"""Measurements for the pure tests: an upright robot on its feet unless told otherwise."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hal.lola.poses import STAND
from hal.lola.sensors import Sensors

DT = 0.012


def sensed(
    angles: NDArray[np.float64] | None = None,
    *,
    stiffness: NDArray[np.float64] | float = 0.0,
    roll_pitch: tuple[float, float] = (0.0, 0.0),
    accel: tuple[float, float, float] = (0.0, 0.0, 9.81),
    load_kg: float = 5.3,
    button: bool = False,
) -> Sensors:
    return Sensors(
        angles_rad=(STAND if angles is None else angles).copy(),
        stiffness=np.broadcast_to(np.asarray(stiffness, dtype=np.float64), 26).copy(),
        temperature_c=np.full(26, 38.0),
        current_a=np.zeros(26),
        status=np.zeros(26),
        gyro_rad_s=np.zeros(3),
        accel_m_s2=np.array(accel),
        torso_roll_pitch_rad=np.array(roll_pitch),
        sonar_m=np.zeros(2),
        fsr_kg=np.full(8, load_kg / 8.0),
        battery=0.8,
        battery_current_a=-1.0,
        battery_temperature_c=30.0,
        chest_button=button,
        bumper=False,
        body_id="x",
        version="6.0.0",
    )
