"""4x4 rigid transforms and plane angles. float64, metres, radians."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float64]
Vector = NDArray[np.float64]

_LAST = (0.0, 0.0, 0.0, 1.0)


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


def transform(R: Matrix, t: Vector | tuple[float, float, float]) -> Matrix:
    """Rotation and translation as one (4, 4) matrix."""
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = t
    return T


def closed(T: Matrix) -> Matrix:
    """The upper three rows of a transform, (3, 4), with the last one, (4, 4)."""
    whole = np.empty((4, 4))
    whole[:3], whole[3] = T, _LAST
    return whole


def inverse(T_a_b: Matrix) -> Matrix:
    """T_b_a of a rigid T_a_b."""
    R = T_a_b[:3, :3].T
    return transform(R, -R @ T_a_b[:3, 3])


def planar(x: float, y: float, yaw: float) -> Matrix:
    """A pose on the floor as a (4, 4) transform."""
    return transform(rot_z(yaw), (x, y, 0.0))


def yaw_of(T: Matrix) -> float:
    """Azimuth of the transform's x axis about z."""
    return math.atan2(T[1, 0], T[0, 0])


def wrap(angle: float) -> float:
    """The same angle in (-pi, pi]."""
    wrapped = math.remainder(angle, 2.0 * math.pi)
    return math.pi if wrapped == -math.pi else wrapped


R_CAMERABODY_OPTICAL: Matrix = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
"""From a camera's optical axes (x right, y down, z forward) to body axes (x forward, z up)."""
