"""Inverse kinematics of the NAO's legs, whose two hip yaw-pitch joints share one motor.

Closed form for one leg: the ankle's two axes meet, and so do the hip's three, so the hip's place
in the foot's frame gives knee and ankle, and what rotation is left gives the hip. With both soles
given, eleven joints meet twelve conditions; the torso's own yaw is the one left free, and is turned
until both legs ask the shared joint for the same angle.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from hal.nao.feet import SOLE_IN_ANKLE_M
from hal.nao.joints import JOINT_INDEX, JOINTS

_HIP = JOINTS[JOINT_INDEX["LHipYawPitch"]].origin_m
_HIP_Y, _HIP_Z = _HIP[1], _HIP[2]
_THIGH = -JOINTS[JOINT_INDEX["LKneePitch"]].origin_m[2]
_TIBIA = -JOINTS[JOINT_INDEX["LAnklePitch"]].origin_m[2]
_SOLE = -SOLE_IN_ANKLE_M[2]
_QUARTER = math.pi / 4.0
_ROUNDS = 8
_AGREED_RAD = 1e-12

FIRST_LEFT = JOINT_INDEX["LHipYawPitch"]
FIRST_RIGHT = JOINT_INDEX["RHipYawPitch"]


@njit(cache=True, nogil=True)
def _hip_in_foot(R, t, side):  # type: ignore[no-untyped-def]
    """Hip centre in the ankle's frame, axes of the sole; `R`, `t` are the sole in the torso."""
    rest = np.empty(3)
    rest[0] = -t[0]
    rest[1] = side * _HIP_Y - t[1]
    rest[2] = _HIP_Z - t[2]
    hip = np.empty(3)
    for i in range(3):
        hip[i] = R[0, i] * rest[0] + R[1, i] * rest[1] + R[2, i] * rest[2]
    hip[2] -= _SOLE
    return hip


@njit(cache=True, nogil=True)
def _times(A, B):  # type: ignore[no-untyped-def]
    """Product of two (3, 3); numba's own `@` wants scipy."""
    out = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            out[i, j] = A[i, 0] * B[0, j] + A[i, 1] * B[1, j] + A[i, 2] * B[2, j]
    return out


@njit(cache=True, nogil=True)
def _rx(angle):  # type: ignore[no-untyped-def]
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


@njit(cache=True, nogil=True)
def _ry(angle):  # type: ignore[no-untyped-def]
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


@njit(cache=True, nogil=True)
def _rz(angle):  # type: ignore[no-untyped-def]
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


@njit(cache=True, nogil=True)
def leg_angles(R, t, side, out):  # type: ignore[no-untyped-def]
    """Six angles of one leg, hip yaw-pitch first, into `out`; False if the foot is out of reach.

    `R` (3, 3) and `t` (3,): the sole in the torso's frame. `side`: 1 left, -1 right.
    """
    hip = _hip_in_foot(R, t, side)
    reach = math.sqrt(hip[0] ** 2 + hip[1] ** 2 + hip[2] ** 2)
    bend = (reach**2 - _THIGH**2 - _TIBIA**2) / (2.0 * _THIGH * _TIBIA)
    within = -1.0 <= bend <= 1.0
    knee = math.acos(min(max(bend, -1.0), 1.0))
    ankle_roll = math.atan2(hip[1], hip[2])
    up = math.sqrt(hip[1] ** 2 + hip[2] ** 2)
    behind = -_THIGH * math.sin(knee)
    above = _TIBIA + _THIGH * math.cos(knee)
    ankle_pitch = math.atan2(behind, above) - math.atan2(hip[0], up)
    R_hip = _times(_times(R, _rx(-ankle_roll)), _ry(-ankle_pitch - knee))
    M = _times(_rx(-side * _QUARTER), R_hip)
    out[0] = side * math.atan2(M[0, 1], M[1, 1])
    out[1] = math.asin(min(max(M[2, 1], -1.0), 1.0)) + side * _QUARTER
    out[2] = math.atan2(-M[2, 0], M[2, 2])
    out[3] = knee
    out[4] = ankle_pitch
    out[5] = ankle_roll
    return within


@njit(cache=True, nogil=True)
def _sole_in_torso(T_w_torso, yaw, sole):  # type: ignore[no-untyped-def]
    """The sole (x, y, z, yaw in the world) as seen by the torso turned by `yaw` on the spot."""
    R_back = _times(_rz(yaw), T_w_torso[:3, :3]).T.copy()
    t = np.empty(3)
    for i in range(3):
        t[i] = 0.0
        for j in range(3):
            t[i] += R_back[i, j] * (sole[j] - T_w_torso[j, 3])
    return _times(R_back, _rz(sole[3])), t


@njit(cache=True, nogil=True)
def _mismatch(T_w_torso, yaw, left, right, out):  # type: ignore[no-untyped-def]
    """Both legs' angles into `out` (12,); their disagreement about the shared joint, and reach."""
    R, t = _sole_in_torso(T_w_torso, yaw, left)
    reach_left = leg_angles(R, t, 1.0, out[:6])
    R, t = _sole_in_torso(T_w_torso, yaw, right)
    reach_right = leg_angles(R, t, -1.0, out[6:])
    return out[0] - out[6], reach_left and reach_right


@njit(cache=True, nogil=True)
def _solve(T_w_torso, left, right, out):  # type: ignore[no-untyped-def]
    yaw, step = 0.0, 1e-3
    error, reached = _mismatch(T_w_torso, yaw, left, right, out)
    for _ in range(_ROUNDS):
        if abs(error) < _AGREED_RAD:
            break
        ahead, reached = _mismatch(T_w_torso, yaw + step, left, right, out)
        slope = (ahead - error) / step
        if slope == 0.0:
            break
        step_back = -error / slope
        yaw += step_back
        step = max(min(step, 0.1 * abs(step_back)), 1e-7)
        error, reached = _mismatch(T_w_torso, yaw, left, right, out)
    return yaw, reached


def solve_legs(
    T_w_torso: NDArray[np.float64], left: NDArray[np.float64], right: NDArray[np.float64]
) -> tuple[NDArray[np.float64], float, bool]:
    """Both legs' angles for flat soles: (12,) left then right, the torso's extra yaw, in reach.

    `left` and `right`: (4,) x, y, z and yaw of the soles in the frame `T_w_torso` (4, 4) is in.
    """
    out = np.empty(12)
    yaw, reached = _solve(np.ascontiguousarray(T_w_torso), left, right, out)
    return out, float(yaw), bool(reached)
