"""What the simulated robot's LoLA reports of its body.

Not simulated, and always the same: sonar (0 m), touch other than the chest button, motor status.
Currents and the spread of temperatures are plausible figures, not a model.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hal.lola.layout import TOUCH, to_lola
from hal.types import BodyState
from sim_backend.speak.lola_wire import floats, integers, message, strings

Array = NDArray[np.float64]

BODY_ID, HEAD_ID, VERSION = "P0000073A07S94700012", "P0000074A05S93M00061", "6.0.0"
"""The example of `lola_protocol.yaml`, RobotConfig."""

DISCHARGING = 0x20
"""Battery status that both readings of its charging flag take for "not charging"."""

HOLDING_A, BATTERY_A, BATTERY_C = 0.15, -1.4, 33.0
COOLER_C = 8.0


def sensor_message(body: BodyState, gyro: Array, stiffness: Array, button: bool) -> bytes:
    """The 896 bytes of a state. `stiffness`: (26,). `gyro`: (3,), older than the rest at times."""
    touch = [1.0 if button and name == "ChestBoard_Button" else 0.0 for name in TOUCH]
    temperature = body.temperature_max_c - COOLER_C * np.arange(24.0, -1.0, -1.0) / 24.0
    return message(
        [
            floats("Position", to_lola(body.angles_rad)),
            floats("Stiffness", to_lola(stiffness)),
            floats("Temperature", temperature.tolist()),
            floats("Current", HOLDING_A * to_lola(np.maximum(stiffness, 0.0))),
            integers("Status", [0] * 25),
            floats("Battery", [body.battery, DISCHARGING, BATTERY_A, BATTERY_C]),
            floats("Accelerometer", -body.accel_m_s2),
            floats("Gyroscope", gyro),
            floats("Angles", body.torso_roll_pitch_rad),
            floats("Sonar", [0.0, 0.0]),
            floats("FSR", body.fsr_kg),
            floats("Touch", touch),
            strings("RobotConfig", [BODY_ID, VERSION, HEAD_ID, VERSION]),
        ]
    )
