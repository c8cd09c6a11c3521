"""LoLA's sensor message: bytes in, measurements in our units and order out.

Source: `lola_protocol.yaml`, sensor_message. Where sources there disagree: the battery's order is
Charge, Status, Current, Temperature; all three axes of the accelerometer are negated (BH, ND); the
gyroscope's are taken as they are, for those who say its z is inverted say so relative to a V5.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import msgspec
import numpy as np
from msgspec import Meta
from numpy.typing import NDArray

from hal.errors import HalError
from hal.lola.layout import SENSOR_BYTES, TOUCH, from_lola

Array = NDArray[np.float64]
_Joints = Annotated[list[float], Meta(min_length=25, max_length=25)]
_Two = Annotated[list[float], Meta(min_length=2, max_length=2)]
_Three = Annotated[list[float], Meta(min_length=3, max_length=3)]
_Four = Annotated[list[float], Meta(min_length=4, max_length=4)]
_Eight = Annotated[list[float], Meta(min_length=8, max_length=8)]
_Touch = Annotated[list[float], Meta(min_length=14, max_length=14)]
_Config = Annotated[list[str], Meta(min_length=4, max_length=4)]

_BUTTON = TOUCH.index("ChestBoard_Button")
_BUMPERS = [i for i, name in enumerate(TOUCH) if "Bumper" in name]
_PRESSED = 0.5


class MessageError(HalError):
    """Bytes that are not the message they should be; the text says what is wrong."""


class _Message(msgspec.Struct, rename="pascal"):
    """The map as it comes; keys in any order, integers or floats."""

    position: _Joints
    stiffness: _Joints
    temperature: _Joints
    current: _Joints
    status: _Joints
    battery: _Four
    accelerometer: _Three
    gyroscope: _Three
    angles: _Two
    sonar: _Two
    fsr: _Eight = msgspec.field(name="FSR")
    touch: _Touch
    robot_config: _Config


@dataclass(frozen=True, slots=True)
class Sensors:
    """One message, all of it finite.

    `angles_rad`, `stiffness`, `temperature_c`, `current_a`, `status`: (26,), order of `JOINT_NAMES`
    (hands 0 closed to 1 open; status 0 to 3, from regular to critically hot). `gyro_rad_s`,
    `accel_m_s2`: (3,), torso axes, +9.81 on z when standing. `torso_roll_pitch_rad`, `sonar_m`:
    (2,). `fsr_kg`: (8,). `battery`: charge 0 to 1. `body_id`, `version`: of RobotConfig.
    """

    angles_rad: Array
    stiffness: Array
    temperature_c: Array
    current_a: Array
    status: Array
    gyro_rad_s: Array
    accel_m_s2: Array
    torso_roll_pitch_rad: Array
    sonar_m: Array
    fsr_kg: Array
    battery: float
    battery_current_a: float
    battery_temperature_c: float
    chest_button: bool
    bumper: bool
    body_id: str
    version: str


_DECODER = msgspec.msgpack.Decoder(_Message)


def decode_sensors(data: bytes | bytearray | memoryview) -> Sensors:
    """One whole message. Raises MessageError if it is not one, or holds a number that is none."""
    if len(data) != SENSOR_BYTES:
        raise MessageError(f"a sensor message has {SENSOR_BYTES} bytes, not {len(data)}")
    try:
        message = _DECODER.decode(data)
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise MessageError(f"not a sensor message: {error}") from None
    return _checked(message)


def _checked(message: _Message) -> Sensors:
    m = message
    joints = np.array([m.position, m.stiffness, m.temperature, m.current, m.status])
    inertial = m.gyroscope + m.accelerometer + m.angles
    rest = np.array(inertial + m.sonar + m.fsr + m.battery + m.touch)
    if not (np.isfinite(joints).all() and np.isfinite(rest).all()):
        raise MessageError("a sensor message holds a number that is not finite")
    position, stiffness, temperature, current, status = (from_lola(row) for row in joints)
    touch = rest[22:]
    return Sensors(
        angles_rad=position,
        stiffness=stiffness,
        temperature_c=temperature,
        current_a=current,
        status=status,
        gyro_rad_s=rest[0:3],
        accel_m_s2=-rest[3:6],
        torso_roll_pitch_rad=rest[6:8],
        sonar_m=rest[8:10],
        fsr_kg=rest[10:18],
        battery=float(rest[18]),
        battery_current_a=float(rest[20]),
        battery_temperature_c=float(rest[21]),
        chest_button=bool(touch[_BUTTON] > _PRESSED),
        bumper=bool((touch[_BUMPERS] > _PRESSED).any()),
        body_id=m.robot_config[0],
        version=m.robot_config[1],
    )
