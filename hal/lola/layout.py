"""Names, sizes and orders of what LoLA sends and takes.

Source: `lola_protocol.yaml`, joint_order, sensor_message and actuator_message.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hal.nao.joints import JOINT_INDEX, JOINT_NAMES

SENSOR_BYTES = 896
ACTUATOR_BYTES = 786
PERIOD_S = 0.012

LOLA_JOINTS: tuple[str, ...] = (
    "HeadYaw",
    "HeadPitch",
    "LShoulderPitch",
    "LShoulderRoll",
    "LElbowYaw",
    "LElbowRoll",
    "LWristYaw",
    "LHipYawPitch",
    "LHipRoll",
    "LHipPitch",
    "LKneePitch",
    "LAnklePitch",
    "LAnkleRoll",
    "RHipRoll",
    "RHipPitch",
    "RKneePitch",
    "RAnklePitch",
    "RAnkleRoll",
    "RShoulderPitch",
    "RShoulderRoll",
    "RElbowYaw",
    "RElbowRoll",
    "RWristYaw",
    "LHand",
    "RHand",
)
"""25 joints: both hip yaw-pitch joints have one motor, here the left one."""

TOUCH: tuple[str, ...] = (
    "ChestBoard_Button",
    "Head_Touch_Front",
    "Head_Touch_Middle",
    "Head_Touch_Rear",
    "LFoot_Bumper_Left",
    "LFoot_Bumper_Right",
    "LHand_Touch_Back",
    "LHand_Touch_Left",
    "LHand_Touch_Right",
    "RFoot_Bumper_Left",
    "RFoot_Bumper_Right",
    "RHand_Touch_Back",
    "RHand_Touch_Left",
    "RHand_Touch_Right",
)

ACTUATOR_FLOATS: dict[str, int] = {
    "Position": 25,
    "Stiffness": 25,
    "Chest": 3,
    "LEar": 10,
    "REar": 10,
    "LEye": 24,
    "REye": 24,
    "LFoot": 3,
    "RFoot": 3,
    "Skull": 12,
}
"""Length of each array of float32; `Sonar`, two booleans, is the eleventh field."""

_SENT = np.array([JOINT_INDEX[name] for name in LOLA_JOINTS])
_SHARED_HIP = {"RHipYawPitch": "LHipYawPitch"}
_READ = np.array([LOLA_JOINTS.index(_SHARED_HIP.get(name, name)) for name in JOINT_NAMES])


def to_lola(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """(26,) in the order of `JOINT_NAMES` to (25,) in LoLA's; the left hip's motor is both's."""
    return values[_SENT]


def from_lola(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """(25,) in LoLA's order to (26,) in that of `JOINT_NAMES`."""
    return values[_READ]
