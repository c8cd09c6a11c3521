"""What is read from ALMemory, all in one call, and what it means.

Device keys are refreshed twice a second on NAOqi 2.8 (`naoqi_api.yaml`, ALMemory); events at once.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hal.nao.joints import JOINT_NAMES

_DEVICE = "Device/SubDeviceList"
_CELLS = ("FrontLeft", "FrontRight", "RearLeft", "RearRight")

INERTIAL_KEYS = tuple(
    f"{_DEVICE}/InertialSensor/{kind}{axis}/Sensor/Value"
    for kind, axes in (("Gyroscope", "XYZ"), ("Accelerometer", "XYZ"), ("Angle", "XY"))
    for axis in axes
)
FSR_KEYS = tuple(
    f"{_DEVICE}/{side}Foot/FSR/{cell}/Sensor/Value" for side in "LR" for cell in _CELLS
)
BATTERY_KEY = f"{_DEVICE}/Battery/Charge/Sensor/Value"
TEMPERATURE_KEYS = tuple(f"{_DEVICE}/{name}/Temperature/Sensor/Value" for name in JOINT_NAMES)
FALLEN_KEY = "robotHasFallen"
CONTACT_KEY = "footContactChanged"

KEYS: tuple[str, ...] = (
    *INERTIAL_KEYS,
    *FSR_KEYS,
    BATTERY_KEY,
    *TEMPERATURE_KEYS,
    FALLEN_KEY,
    CONTACT_KEY,
)


def temperature_status_key(joint: str) -> str:
    """0 when a joint's temperature is well."""
    return f"{_DEVICE}/{joint}/Temperature/Sensor/Status"


LYING_RAD = math.radians(60.0)
"""A torso that leans more than this has fallen, whatever the events say."""
CONTACT_KG = 0.2


@dataclass(frozen=True, slots=True)
class Sensed:
    """One reading of the memory; what the robot does not offer is zero, or None for events.

    `gyro_rad_s`, `accel_m_s2`: (3,). `tilt_rad`: (2,), roll and pitch. `fsr_kg`: (8,).
    """

    gyro_rad_s: NDArray[np.float64]
    accel_m_s2: NDArray[np.float64]
    tilt_rad: NDArray[np.float64]
    fsr_kg: NDArray[np.float64]
    battery: float
    temperature_max_c: float
    has_fallen: bool | None
    has_contact: bool | None

    @property
    def lies(self) -> bool:
        """Whether it has fallen: as NAOqi says, or as the torso leans."""
        return bool(self.has_fallen) or bool((np.abs(self.tilt_rad) > LYING_RAD).any())

    @property
    def hangs(self) -> bool:
        """Whether no foot touches anything: lifted."""
        if self.has_contact is not None:
            return not self.has_contact
        return bool(self.fsr_kg.any()) and float(self.fsr_kg.sum()) < CONTACT_KG


NOTHING = Sensed(
    np.zeros(3), np.zeros(3), np.zeros(2), np.zeros(8), 0.0, 0.0, None, None
)  # fmt: skip


def sensed(values: Sequence[object]) -> Sensed:
    """The meaning of getListData(KEYS). Raises ValueError when it has another length."""
    if len(values) != len(KEYS):
        raise ValueError(f"ALMemory gave {len(values)} values for {len(KEYS)} keys")
    found = dict(zip(KEYS, values, strict=True))
    inertial = np.array([_number(found[key]) for key in INERTIAL_KEYS])
    return Sensed(
        gyro_rad_s=inertial[0:3],
        accel_m_s2=inertial[3:6],
        tilt_rad=inertial[6:8],
        fsr_kg=np.array([_number(found[key]) for key in FSR_KEYS]),
        battery=min(max(_number(found[BATTERY_KEY]), 0.0), 1.0),
        temperature_max_c=max(_number(found[key]) for key in TEMPERATURE_KEYS),
        has_fallen=_flag(found[FALLEN_KEY]),
        has_contact=_flag(found[CONTACT_KEY]),
    )


def _number(value: object) -> float:
    if isinstance(value, int | float) and math.isfinite(value):
        return float(value)
    return 0.0


def _flag(value: object) -> bool | None:
    """An event's value; None for a key that has never been raised."""
    return bool(value) if isinstance(value, bool | int | float) else None
