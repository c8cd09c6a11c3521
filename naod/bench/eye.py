"""Where the camera is on a walk up to an object: sway of the gait, sweeps of the head."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

PERIOD_S = 1.0 / 15.0
APPROACH = {"can": (1.3, 0.55), "board": (1.9, 0.8)}
"""From how far to how near, m: there the whole object stays in the picture."""

EYE_M = 0.47
SWAY_M, SWAY_HZ = 0.02, 1.0
ROLL_RAD = 0.03
YAW_RAD, YAW_HZ = math.radians(14.0), 0.7
PITCH_RAD, PITCH_HZ = math.radians(6.0), 0.9
"""At the fastest 62 degrees a second sideways and 34 up and down, together in every direction."""


def eye(T_world_object: NDArray[np.float64], way_m: float, t_s: float) -> NDArray[np.float64]:
    """T_world_camera (4, 4) before the object, `way_m` away, at a moment of gait and head."""
    gait = 2.0 * math.pi * SWAY_HZ * t_s
    place = T_world_object[:3, 3] + way_m * T_world_object[:3, 2]
    place += SWAY_M * math.sin(gait) * T_world_object[:3, 0]
    place[2] = EYE_M
    ahead = T_world_object[:3, 3] - place
    z = ahead / np.linalg.norm(ahead)
    x = np.cross(z, (0.0, 0.0, 1.0))
    x /= np.linalg.norm(x)
    T = np.eye(4)
    T[:3, :3] = np.column_stack([x, np.cross(z, x), z]) @ _head(gait, t_s)
    T[:3, 3] = place
    return T


def _head(gait: float, t_s: float) -> NDArray[np.float64]:
    yaw = YAW_RAD * math.sin(2.0 * math.pi * YAW_HZ * t_s)
    pitch = PITCH_RAD * math.sin(2.0 * math.pi * PITCH_HZ * t_s)
    roll = ROLL_RAD * math.sin(gait)
    return _turn(1, yaw) @ _turn(0, pitch) @ _turn(2, roll)


def _turn(axis: int, angle: float) -> NDArray[np.float64]:
    R = np.eye(3)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R[i, i] = R[j, j] = math.cos(angle)
    R[j, i] = math.sin(angle)
    R[i, j] = -R[j, i]
    return R
