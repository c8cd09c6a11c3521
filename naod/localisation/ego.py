"""The ego-cylinder: where the object is in the base frame (equation 6)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from naod.geometry.transforms import Matrix, wrap


@dataclass(frozen=True, slots=True)
class EgoPose:
    """Distance, azimuth, height of the object, and azimuth of its z axis, in the base frame."""

    rho_m: float
    theta_rad: float
    z_m: float
    phi_rad: float

    @property
    def x_m(self) -> float:
        """Forward coordinate of the object."""
        return self.rho_m * math.cos(self.theta_rad)

    @property
    def y_m(self) -> float:
        """Leftward coordinate of the object."""
        return self.rho_m * math.sin(self.theta_rad)


def ego_pose(T_base_object: Matrix) -> EgoPose:
    """The ego-cylinder coordinates of an object (equation 6)."""
    x, y, z = (float(v) for v in T_base_object[:3, 3])
    phi = math.atan2(float(T_base_object[1, 2]), float(T_base_object[0, 2]))
    return EgoPose(math.hypot(x, y), math.atan2(y, x), z, phi)


def from_cartesian(x: float, y: float, z: float, phi: float) -> EgoPose:
    """Ego-cylinder coordinates of a point and an azimuth."""
    return EgoPose(math.hypot(x, y), math.atan2(y, x), z, wrap(phi))


def cartesian_jacobian(T_base_object: Matrix, T_base_camera: Matrix) -> NDArray[np.float64]:
    """(4, 6): how x, y, z, phi in the base move with an error of the pose in the camera.

    The error is (translation, rotation vector) along the camera's axes, as in
    `naod.pose.result.ObjectPose.covariance`.
    """
    R_base_camera = T_base_camera[:3, :3]
    zx, zy = float(T_base_object[0, 2]), float(T_base_object[1, 2])
    zz = float(T_base_object[2, 2])
    square = max(zx * zx + zy * zy, 1e-9)
    # d(axis) = omega x axis, and phi = atan2(axis_y, axis_x)
    dphi = np.array([-zx * zz, -zy * zz, square]) / square
    J = np.zeros((4, 6))
    J[:3, :3] = R_base_camera
    J[3, 3:] = dphi @ R_base_camera
    return J
