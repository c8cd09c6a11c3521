"""Head limits: the shell makes the pitch's range depend on the yaw.

Source: `nao_kinematics.yaml`, head_pitch_limits_by_yaw (NAOqi documentation; V4, V5 and V6 alike).
"""

from __future__ import annotations

import math

import numpy as np

from hal.errors import MotionRefusedError
from hal.nao.joints import JOINT_INDEX, JOINTS
from hal.types import HeadAngles

# yaw, least pitch, greatest pitch, for yaw of one sign; the other side is its mirror image
_ROWS = (
    (0.0, -0.671951, 0.515047),
    (0.486074, -0.671951, 0.422021),
    (0.756077, -0.548033, 0.370010),
    (0.903033, -0.479965, 0.330041),
    (1.089958, -0.430049, 0.300022),
    (1.526988, -0.330041, 0.200015),
    (2.086017, -0.449073, 0.330041),
)
_YAW = np.array([row[0] for row in _ROWS])
_PITCH_MIN = np.array([row[1] for row in _ROWS])
_PITCH_MAX = np.array([row[2] for row in _ROWS])

YAW_MAX_RAD = JOINTS[JOINT_INDEX["HeadYaw"]].upper_rad
_PITCH_JOINT = JOINTS[JOINT_INDEX["HeadPitch"]]

# the documented no-load speeds are below the URDF's velocity limits: nao_kinematics.yaml, motors
HEAD_SPEED_MAX_RAD_S = (7.46, 6.47)


def pitch_range_rad(yaw_rad: float) -> tuple[float, float]:
    """Least and greatest head pitch at a yaw, interpolated linearly between the rows."""
    yaw = abs(yaw_rad)
    low = float(np.interp(yaw, _YAW, _PITCH_MIN))
    high = float(np.interp(yaw, _YAW, _PITCH_MAX))
    return max(low, _PITCH_JOINT.lower_rad), min(high, _PITCH_JOINT.upper_rad)


def clip_head(target: HeadAngles) -> HeadAngles:
    """The nearest allowed angles, yaw first. Raises MotionRefusedError if not finite."""
    if not (math.isfinite(target.yaw_rad) and math.isfinite(target.pitch_rad)):
        raise MotionRefusedError(f"head angles are not finite: {target}")
    yaw = min(max(target.yaw_rad, -YAW_MAX_RAD), YAW_MAX_RAD)
    low, high = pitch_range_rad(yaw)
    return HeadAngles(yaw, min(max(target.pitch_rad, low), high))
