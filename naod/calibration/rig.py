"""From the torso to the picture: neck, head, camera askew, lens; and how all that moves a pixel."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hal.nao.cameras import MOUNTS
from hal.nao.joints import JOINT_INDEX, JOINTS
from hal.types import CameraName, HeadAngles
from naod.calibration.lens import project
from naod.geometry.transforms import R_CAMERABODY_OPTICAL, Matrix, rot_x, rot_y, rot_z, transform

CORRECTION, LENS, WIDER, OBJECT, HEADS = slice(0, 3), slice(3, 8), 8, slice(9, 15), 15
"""Where each unknown is among the columns; two for each view's head from `HEADS` on."""

NECK_M = np.array(JOINTS[JOINT_INDEX["HeadYaw"]].origin_m)
"""Both joints of the neck turn about this point of the torso."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """All unknowns.

    `correction_rad`: (3,) roll, pitch, yaw as in `BodyModel`; `lens`: (5,) fx, fy, cx, cy in pixels
    and k1; `wider_px`: how much wider the rectangle looks on each side; `T_torso_object` (4, 4);
    `heads_rad`: (views, 2) by which each view's yaw and pitch were off what the encoders said.
    """

    correction_rad: NDArray[np.float64]
    lens: NDArray[np.float64]
    wider_px: float
    T_torso_object: Matrix
    heads_rad: NDArray[np.float64]

    def moved(self, step: NDArray[np.float64]) -> Estimate:
        """The estimate after a step along all columns."""
        T = self.T_torso_object.copy()
        T[:3, 3] += step[OBJECT][:3]
        T[:3, :3] = _turn(step[OBJECT][3:]) @ T[:3, :3]
        return replace(
            self,
            correction_rad=self.correction_rad + step[CORRECTION],
            lens=self.lens + step[LENS],
            wider_px=self.wider_px + float(step[WIDER]),
            T_torso_object=T,
            heads_rad=self.heads_rad + step[HEADS:].reshape(-1, 2),
        )


@dataclass(frozen=True, slots=True)
class Rig:
    """What is not unknown: which camera, and (4,) k2, p1, p2, k3 of its lens."""

    camera: CameraName
    others: NDArray[np.float64]

    def T_torso_camera(self, head: HeadAngles, correction_rad: NDArray[np.float64]) -> Matrix:
        """(4, 4) for one pose of the head."""
        R_head = rot_z(head.yaw_rad) @ rot_y(head.pitch_rad)
        mount = MOUNTS[self.camera]
        R = R_head @ rot_y(mount.pitch_down_rad) @ _askew(correction_rad)[0] @ R_CAMERABODY_OPTICAL
        return transform(R, NECK_M + R_head @ np.array(mount.origin_m))

    def pixels(
        self, at: Estimate, head: HeadAngles, number: int, points_in_object: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Pixels (n, 2) of points (n, 3) in view `number`, and (n, 2, `HEADS` + 2) how they move.

        Of the heads' columns only this view's own two, as no other moves what it sees.
        """
        mount = MOUNTS[self.camera]
        offset = at.heads_rad[number]
        R_head = rot_z(head.yaw_rad + offset[0]) @ rot_y(head.pitch_rad + offset[1])
        R_askew, R_askew_by = _askew(at.correction_rad)
        R_mount = rot_y(mount.pitch_down_rad)
        turned = points_in_object @ at.T_torso_object[:3, :3].T
        in_torso = turned + at.T_torso_object[:3, 3]
        in_head = (in_torso - NECK_M) @ R_head
        level = (in_head - np.array(mount.origin_m)) @ R_mount
        in_camera = level @ R_askew @ R_CAMERABODY_OPTICAL
        pixels, by_point, by_lens = project(in_camera, at.lens, self.others)

        J = np.zeros((len(pixels), 2, HEADS + 2))
        R_head_camera = R_mount @ R_askew @ R_CAMERABODY_OPTICAL
        for k, derivative in enumerate(R_askew_by):
            J[:, :, k] = _times(by_point, level @ derivative @ R_CAMERABODY_OPTICAL)
        J[:, :, LENS] = by_lens
        by_torso = by_point @ (R_head @ R_head_camera).T
        J[:, :, OBJECT.start : OBJECT.start + 3] = by_torso
        for k in range(3):
            J[:, :, OBJECT.start + 3 + k] = _times(by_torso, np.cross(np.eye(3)[k], turned))
        about_z = np.cross((0.0, 0.0, 1.0), in_torso - NECK_M)
        J[:, :, HEADS] = _times(by_torso, -about_z)
        about_y = np.cross((0.0, 1.0, 0.0), in_head)
        J[:, :, HEADS + 1] = _times(by_point @ R_head_camera.T, -about_y)
        return pixels, J


def columns_of(number: int) -> NDArray[np.int64]:
    """The columns, among all, of those that `pixels` gives for a view."""
    own = HEADS + 2 * number
    return np.append(np.arange(HEADS), (own, own + 1))


def _times(by: NDArray[np.float64], moved: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 2, 3) times (n, 3): (n, 2)."""
    return np.asarray(np.einsum("nij,nj->ni", by, moved), dtype=np.float64)


def _askew(angles: NDArray[np.float64]) -> tuple[Matrix, tuple[Matrix, Matrix, Matrix]]:
    """The correction's rotation, and it by roll, pitch and yaw."""
    roll, pitch, yaw = (float(angle) for angle in angles)
    X, Y, Z = rot_x(roll), rot_y(pitch), rot_z(yaw)
    hats = [_hat(axis) for axis in np.eye(3)]
    return Z @ Y @ X, (Z @ Y @ X @ hats[0], Z @ Y @ hats[1] @ X, hats[2] @ Z @ Y @ X)


def _hat(v: NDArray[np.float64]) -> Matrix:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def _turn(vector: NDArray[np.float64]) -> Matrix:
    """The rotation by a rotation vector (Rodrigues)."""
    angle = float(np.linalg.norm(vector))
    if angle < 1e-12:
        return np.eye(3) + _hat(vector)
    K = _hat(vector / angle)
    return np.eye(3) + math.sin(angle) * K + (1.0 - math.cos(angle)) * K @ K
