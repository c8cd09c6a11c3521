"""The joints of the NAO H25 body, V4 to V6: order, axes, places and limits.

Source: `nao_kinematics.yaml`, from the naoV50 URDF and the NAOqi 2.8 documentation.
Where two published limits differ, the narrower one is taken.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Vector3 = tuple[float, float, float]
HALF_SQRT = 0.7071067811865476


@dataclass(frozen=True, slots=True)
class Joint:
    """One revolute joint; at the zero posture all joint frames are parallel to the torso.

    `origin_m` is in the parent link's frame. Hands are a fraction of their opening, 0 to 1.
    """

    name: str
    parent: str
    child: str
    origin_m: Vector3
    axis: Vector3
    lower_rad: float
    upper_rad: float
    speed_max_rad_s: float
    effort_max_n_m: float


_X: Vector3 = (1.0, 0.0, 0.0)
_Y: Vector3 = (0.0, 1.0, 0.0)
_Z: Vector3 = (0.0, 0.0, 1.0)
_LEFT_HIP: Vector3 = (0.0, HALF_SQRT, -HALF_SQRT)
_RIGHT_HIP: Vector3 = (0.0, HALF_SQRT, HALF_SQRT)

# name, parent link, child link, origin in the parent in m, axis
_PLACES: tuple[tuple[str, str, str, Vector3, Vector3], ...] = (
    ("HeadYaw", "torso", "Neck", (0.0, 0.0, 0.1265), _Z),
    ("HeadPitch", "Neck", "Head", (0.0, 0.0, 0.0), _Y),
    ("LShoulderPitch", "torso", "LShoulder", (0.0, 0.098, 0.1), _Y),
    ("LShoulderRoll", "LShoulder", "LBicep", (0.0, 0.0, 0.0), _Z),
    ("LElbowYaw", "LBicep", "LElbow", (0.105, 0.015, 0.0), _X),
    ("LElbowRoll", "LElbow", "LForeArm", (0.0, 0.0, 0.0), _Z),
    ("LWristYaw", "LForeArm", "l_wrist", (0.05595, 0.0, 0.0), _X),
    ("LHand", "l_wrist", "l_gripper", (0.05775, 0.0, -0.01231), _X),
    ("LHipYawPitch", "torso", "LPelvis", (0.0, 0.05, -0.085), _LEFT_HIP),
    ("LHipRoll", "LPelvis", "LHip", (0.0, 0.0, 0.0), _X),
    ("LHipPitch", "LHip", "LThigh", (0.0, 0.0, 0.0), _Y),
    ("LKneePitch", "LThigh", "LTibia", (0.0, 0.0, -0.1), _Y),
    ("LAnklePitch", "LTibia", "LAnklePitch", (0.0, 0.0, -0.1029), _Y),
    ("LAnkleRoll", "LAnklePitch", "l_ankle", (0.0, 0.0, 0.0), _X),
    ("RHipYawPitch", "torso", "RPelvis", (0.0, -0.05, -0.085), _RIGHT_HIP),
    ("RHipRoll", "RPelvis", "RHip", (0.0, 0.0, 0.0), _X),
    ("RHipPitch", "RHip", "RThigh", (0.0, 0.0, 0.0), _Y),
    ("RKneePitch", "RThigh", "RTibia", (0.0, 0.0, -0.1), _Y),
    ("RAnklePitch", "RTibia", "RAnklePitch", (0.0, 0.0, -0.1029), _Y),
    ("RAnkleRoll", "RAnklePitch", "r_ankle", (0.0, 0.0, 0.0), _X),
    ("RShoulderPitch", "torso", "RShoulder", (0.0, -0.098, 0.1), _Y),
    ("RShoulderRoll", "RShoulder", "RBicep", (0.0, 0.0, 0.0), _Z),
    ("RElbowYaw", "RBicep", "RElbow", (0.105, -0.015, 0.0), _X),
    ("RElbowRoll", "RElbow", "RForeArm", (0.0, 0.0, 0.0), _Z),
    ("RWristYaw", "RForeArm", "r_wrist", (0.05595, 0.0, 0.0), _X),
    ("RHand", "r_wrist", "r_gripper", (0.05775, 0.0, -0.01231), _X),
)

# lower and upper limit in rad, speed in rad/s, effort in N m
_FIGURES: dict[str, tuple[float, float, float, float]] = {
    "HeadYaw": (-2.08567, 2.08567, 8.26797, 1.547),
    "HeadPitch": (-0.671952, 0.514872, 7.19407, 1.532),
    "LShoulderPitch": (-2.08567, 2.08567, 8.26797, 1.329),
    "LShoulderRoll": (-0.314159, 1.32645, 7.19407, 1.7835),
    "LElbowYaw": (-2.08567, 2.08567, 8.26797, 1.547),
    "LElbowRoll": (-1.5446, -0.0349066, 7.19407, 1.532),
    "LWristYaw": (-1.82387, 1.82387, 24.6229, 0.4075),
    "LHand": (0.0, 1.0, 8.33, 0.292),
    "LHipYawPitch": (-1.14529, 0.740718, 4.16174, 3.348),
    "LHipRoll": (-0.379435, 0.79046, 4.16174, 3.348),
    "LHipPitch": (-1.535889, 0.48398, 6.40239, 3.023),
    "LKneePitch": (-0.0923279, 2.112528, 6.40239, 3.023),
    "LAnklePitch": (-1.18944, 0.922581, 6.40239, 3.023),
    "LAnkleRoll": (-0.397761, 0.768992, 4.16174, 3.348),
    "RHipYawPitch": (-1.14529, 0.740718, 4.16174, 3.348),
    "RHipRoll": (-0.79046, 0.379435, 4.16174, 3.348),
    "RHipPitch": (-1.535889, 0.48398, 6.40239, 3.0226),
    "RKneePitch": (-0.0923279, 2.11255, 6.40239, 3.0226),
    "RAnklePitch": (-1.1863, 0.932006, 6.40239, 3.0226),
    "RAnkleRoll": (-0.768992, 0.397761, 4.16174, 3.348),
    "RShoulderPitch": (-2.08567, 2.08567, 8.26797, 1.329),
    "RShoulderRoll": (-1.32645, 0.314159, 7.19407, 1.783),
    "RElbowYaw": (-2.08567, 2.08567, 8.26797, 1.547),
    "RElbowRoll": (0.0349066, 1.5446, 7.19407, 1.532),
    "RWristYaw": (-1.82387, 1.82387, 24.6229, 0.4075),
    "RHand": (0.0, 1.0, 8.33, 0.292),
}

JOINTS: tuple[Joint, ...] = tuple(
    Joint(name, parent, child, origin, axis, *_FIGURES[name])
    for name, parent, child, origin, axis in _PLACES
)

JOINT_NAMES: tuple[str, ...] = tuple(joint.name for joint in JOINTS)
"""The one joint order of this project (NAOqi's "Body"); backends remap at their edge."""

JOINT_INDEX: dict[str, int] = {name: i for i, name in enumerate(JOINT_NAMES)}

LOWER_RAD: NDArray[np.float64] = np.array([joint.lower_rad for joint in JOINTS])
UPPER_RAD: NDArray[np.float64] = np.array([joint.upper_rad for joint in JOINTS])

ENCODER_STEP_RAD = 2.0 * np.pi / 4096.0
"""12-bit magnetic rotary encoders."""
