"""The standing postures of NAOqi by name: joint angles in rad, hands as a fraction.

Source: `nao_kinematics.yaml`, postures (qiBullet's NaoPosture).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hal.nao.joints import JOINT_NAMES

_POSTURES: dict[str, dict[str, float]] = {
    "Stand": {
        "HeadYaw": 0.0,
        "HeadPitch": -0.17,
        "LShoulderPitch": 1.44258,
        "LShoulderRoll": 0.22446,
        "LElbowYaw": -1.20228,
        "LElbowRoll": -0.41727,
        "LWristYaw": 0.1,
        "LHand": 0.3,
        "LHipYawPitch": -0.17001,
        "LHipRoll": 0.11911,
        "LHipPitch": 0.12742,
        "LKneePitch": -0.09233,
        "LAnklePitch": 0.08742,
        "LAnkleRoll": -0.11079,
        "RHipYawPitch": -0.17001,
        "RHipRoll": -0.1191,
        "RHipPitch": 0.12742,
        "RKneePitch": -0.09233,
        "RAnklePitch": 0.08742,
        "RAnkleRoll": 0.11079,
        "RShoulderPitch": 1.44258,
        "RShoulderRoll": -0.22446,
        "RElbowYaw": 1.20228,
        "RElbowRoll": 0.41727,
        "RWristYaw": 0.1,
        "RHand": 0.3,
    },
    "StandInit": {
        "HeadYaw": 0.0,
        "HeadPitch": 0.0,
        "LShoulderPitch": 1.4,
        "LShoulderRoll": 0.3,
        "LElbowYaw": -1.39,
        "LElbowRoll": -1.01,
        "LWristYaw": 0.0,
        "LHand": 0.25,
        "LHipYawPitch": 0.0,
        "LHipRoll": 0.0,
        "LHipPitch": -0.45,
        "LKneePitch": 0.7,
        "LAnklePitch": -0.35,
        "LAnkleRoll": 0.0,
        "RHipYawPitch": 0.0,
        "RHipRoll": 0.0,
        "RHipPitch": -0.45,
        "RKneePitch": 0.7,
        "RAnklePitch": -0.35,
        "RAnkleRoll": 0.0,
        "RShoulderPitch": 1.4,
        "RShoulderRoll": -0.3,
        "RElbowYaw": 1.39,
        "RElbowRoll": 1.01,
        "RWristYaw": 0.0,
        "RHand": 0.25,
    },
    "StandZero": {
        "HeadYaw": 0.0,
        "HeadPitch": 0.0,
        "LShoulderPitch": 0.0,
        "LShoulderRoll": 0.00873,
        "LElbowYaw": 0.0,
        "LElbowRoll": -0.03491,
        "LWristYaw": 0.0,
        "LHand": 0.0,
        "LHipYawPitch": 0.0,
        "LHipRoll": 0.0,
        "LHipPitch": 0.0,
        "LKneePitch": 0.0,
        "LAnklePitch": 0.0,
        "LAnkleRoll": 0.0,
        "RHipYawPitch": 0.0,
        "RHipRoll": 0.0,
        "RHipPitch": 0.0,
        "RKneePitch": 0.0,
        "RAnklePitch": 0.0,
        "RAnkleRoll": 0.0,
        "RShoulderPitch": 0.0,
        "RShoulderRoll": -0.00873,
        "RElbowYaw": 0.0,
        "RElbowRoll": 0.03491,
        "RWristYaw": 0.0,
        "RHand": 0.0,
    },
    "Crouch": {
        "HeadYaw": 0.0,
        "HeadPitch": 0.1,
        "LShoulderPitch": 1.39686,
        "LShoulderRoll": 0.15961,
        "LElbowYaw": -0.79168,
        "LElbowRoll": -1.07369,
        "LWristYaw": 0.15,
        "LHand": 0.0,
        "LHipYawPitch": -0.25,
        "LHipRoll": -0.08,
        "LHipPitch": -0.7,
        "LKneePitch": 2.11,
        "LAnklePitch": -1.18,
        "LAnkleRoll": 0.077,
        "RHipYawPitch": -0.25,
        "RHipRoll": 0.08,
        "RHipPitch": -0.7,
        "RKneePitch": 2.11,
        "RAnklePitch": -1.18,
        "RAnkleRoll": -0.077,
        "RShoulderPitch": 1.39686,
        "RShoulderRoll": -0.15961,
        "RElbowYaw": 0.79168,
        "RElbowRoll": 1.07369,
        "RWristYaw": -0.15,
        "RHand": 0.0,
    },
}

POSTURE_NAMES: tuple[str, ...] = tuple(_POSTURES)


def posture(name: str) -> NDArray[np.float64]:
    """Angles of a posture, shape (26,), in the order of `JOINT_NAMES`. Raises KeyError."""
    angles = _POSTURES[name]
    return np.array([angles[joint] for joint in JOINT_NAMES])
