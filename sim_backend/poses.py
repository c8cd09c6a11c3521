"""Rigid transforms in space and poses on the floor. float64, metres, radians.

T_a_b maps coordinates in b to coordinates in a. A `Pose` on the floor is (x, y, yaw); its yaw is
never wrapped, so that turning on stays continuous.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float64]
Pose = tuple[float, float, float]

ORIGIN: Pose = (0.0, 0.0, 0.0)

R_BODY_OPTICAL: Matrix = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
"""Optical axes (x right, y down, z forward) to body axes (x forward, y left, z up)."""


def rot_x(angle: float) -> Matrix:
    """Rotation about x, (3, 3)."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def rot_y(angle: float) -> Matrix:
    """Rotation about y, (3, 3)."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def rot_z(angle: float) -> Matrix:
    """Rotation about z, (3, 3)."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def transform(R: Matrix, t: Matrix | tuple[float, float, float]) -> Matrix:
    """Rotation and translation as one (4, 4) matrix."""
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = t
    return T


def moved(x: float, y: float, z: float) -> Matrix:
    """A translation, (4, 4)."""
    return transform(np.eye(3), (x, y, z))


def inverse(T_a_b: Matrix) -> Matrix:
    """T_b_a of a rigid T_a_b."""
    R = T_a_b[:3, :3].T
    return transform(R, -R @ T_a_b[:3, 3])


def planar(pose: Pose) -> Matrix:
    """A pose on the floor as a (4, 4) transform."""
    return transform(rot_z(pose[2]), (pose[0], pose[1], 0.0))


def compose(a: Pose, b: Pose) -> Pose:
    """The pose `b`, given in the frame of `a`, in the frame `a` is given in."""
    c, s = math.cos(a[2]), math.sin(a[2])
    return (a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], a[2] + b[2])


def between(a: Pose, b: Pose) -> Pose:
    """The pose `b` in the frame of `a`; both given in one frame."""
    c, s = math.cos(a[2]), math.sin(a[2])
    x, y = b[0] - a[0], b[1] - a[1]
    return (c * x + s * y, -s * x + c * y, b[2] - a[2])


def midway(a: Pose, b: Pose) -> Pose:
    """The pose in the middle: mean position, mean direction."""
    return (0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2]))


def mixed(a: Pose, b: Pose, share: float) -> Pose:
    """`a` at share 0, `b` at share 1, in a straight line between."""
    rest = 1.0 - share
    return (rest * a[0] + share * b[0], rest * a[1] + share * b[1], rest * a[2] + share * b[2])


def wrapped(angle: float) -> float:
    """The same angle in (-pi, pi]."""
    folded = math.remainder(angle, 2.0 * math.pi)
    return math.pi if folded == -math.pi else folded


def quat_xyzw(R: Matrix) -> NDArray[np.float64]:
    """Unit quaternion of a rotation, (4,), real part last (Shepperd's method)."""
    trace = float(R[0, 0] + R[1, 1] + R[2, 2])
    diagonal = (float(R[0, 0]), float(R[1, 1]), float(R[2, 2]), trace)
    best = diagonal.index(max(diagonal))
    q = np.empty(4)
    if best == 3:
        q[:] = (R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], 1.0 + trace)
    else:
        i, j, k = best, (best + 1) % 3, (best + 2) % 3
        q[i] = 1.0 - trace + 2.0 * R[i, i]
        q[j] = R[j, i] + R[i, j]
        q[k] = R[k, i] + R[i, k]
        q[3] = R[k, j] - R[j, k]
    return q / np.linalg.norm(q)


def rotation_of(quat: NDArray[np.float64]) -> Matrix:
    """Rotation of a quaternion with its real part last, (3, 3)."""
    x, y, z, w = quat / np.linalg.norm(quat)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def interpolated(T_0: Matrix, T_1: Matrix, share: float) -> Matrix:
    """Between two near poses: straight in position, normalised quaternions in rotation."""
    q_0, q_1 = quat_xyzw(T_0[:3, :3]), quat_xyzw(T_1[:3, :3])
    if float(q_0 @ q_1) < 0.0:
        q_1 = -q_1
    R = rotation_of((1.0 - share) * q_0 + share * q_1)
    return transform(R, (1.0 - share) * T_0[:3, 3] + share * T_1[:3, 3])
