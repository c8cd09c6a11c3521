"""The two poses of the standing engine, and how near to the way between them a robot is.

Stand: NAOqi's StandInit. Seat: legs as NaoDevils' base software sits down, on its knees with the
motors off (`nao_kinematics.yaml`, other_published, naodevils_sit); arms as in NAOqi's Crouch. Both
have the soles flat and parallel, and so has every pose on the straight way between them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hal.nao.joints import JOINT_INDEX, JOINT_NAMES
from hal.nao.postures import posture

Array = NDArray[np.float64]

_SEAT_LEG = {
    "HipYawPitch": 0.0,
    "HipRoll": 0.0,
    "HipPitch": -0.855,
    "KneePitch": 2.11,
    "AnklePitch": -1.18,
    "AnkleRoll": 0.0,
}
_LEG = tuple(_SEAT_LEG)


def _seat() -> Array:
    angles = posture("Crouch")
    for side in "LR":
        for joint, angle in _SEAT_LEG.items():
            angles[JOINT_INDEX[side + joint]] = angle
    return angles


STAND: Array = posture("StandInit")
SEAT: Array = _seat()
LEGS = np.array([i for i, name in enumerate(JOINT_NAMES) if name[1:] in _LEG])
HEAD = np.array([JOINT_INDEX["HeadYaw"], JOINT_INDEX["HeadPitch"]])
ARMS = np.array([i for i in range(len(JOINT_NAMES)) if i not in LEGS and i not in HEAD])

SEATED_WITHIN_RAD = 0.2
ON_THE_WAY_RAD = 0.5


def is_seated(angles: Array) -> bool:
    """Whether the legs (of (26,) angles) are where the robot rests on its knees."""
    return bool(np.abs(angles - SEAT)[LEGS].max() < SEATED_WITHIN_RAD)


def is_on_the_way(angles: Array) -> bool:
    """Whether the legs are near a pose between stand and seat, and so can go to either."""
    way = (SEAT - STAND)[LEGS]
    off = (angles - STAND)[LEGS]
    share = float(np.clip(off @ way / (way @ way), 0.0, 1.0))
    return bool(np.abs(off - share * way).max() < ON_THE_WAY_RAD)
