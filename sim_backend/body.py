"""The robot's body in pybullet: posed, asked for its link frames and for what it touches.

The kinematic walk poses it; a dynamic one would drive its motors and step the same world.
"""

from __future__ import annotations

import tempfile
import threading
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hal.errors import BackendError
from hal.nao.cameras import MOUNTS
from hal.nao.joints import JOINT_NAMES
from hal.types import CameraName, NaoVersion
from sim_backend.poses import (
    R_BODY_OPTICAL,
    Matrix,
    inverse,
    quat_xyzw,
    rot_x,
    rot_y,
    rot_z,
    transform,
)
from sim_backend.quiet import pybullet
from sim_backend.shapes import SHAPES
from sim_backend.urdf import LINK_NAMES, urdf_text

_NO_HANDS = np.array([0.0 if name.endswith("Hand") else 1.0 for name in JOINT_NAMES])


def camera_in_head(
    camera: CameraName, mount_error_deg: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> Matrix:
    """T_head_camera of a head camera, optical axes, (4, 4); with roll, pitch, yaw of its mount."""
    mount = MOUNTS[camera]
    roll, pitch, yaw = np.radians(mount_error_deg)
    R_error = rot_z(yaw) @ rot_y(pitch) @ rot_x(roll)
    return transform(rot_y(mount.pitch_down_rad) @ R_error @ R_BODY_OPTICAL, mount.origin_m)


class Body:
    """A NAO in a pybullet world of its own. Its calls may come from any thread."""

    def __init__(self, version: NaoVersion) -> None:
        self._lock = threading.Lock()
        self._client = pybullet.connect(pybullet.DIRECT)
        self._robot = self._load(version)
        self._joints = self._joint_indices()
        position, orientation = pybullet.getDynamicsInfo(
            self._robot, -1, physicsClientId=self._client
        )[3:5]
        # pybullet speaks of the base by its inertial frame, not by its link frame
        self._T_torso_inertial = _matrix(position, orientation)
        self._T_inertial_torso = inverse(self._T_torso_inertial)

    def _load(self, version: NaoVersion) -> int:
        flags = pybullet.URDF_USE_INERTIA_FROM_FILE | pybullet.URDF_MAINTAIN_LINK_ORDER
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "nao.urdf"
            path.write_text(urdf_text(version), encoding="utf-8")
            return int(pybullet.loadURDF(str(path), flags=flags, physicsClientId=self._client))

    def _joint_indices(self) -> list[int]:
        count = pybullet.getNumJoints(self._robot, physicsClientId=self._client)
        names = {
            pybullet.getJointInfo(self._robot, i, physicsClientId=self._client)[1].decode(): i
            for i in range(count)
        }
        return [names[name] for name in JOINT_NAMES]

    def total_mass_kg(self) -> float:
        """Mass of all links as pybullet has them."""
        rows = [
            pybullet.getDynamicsInfo(self._robot, i, physicsClientId=self._client)
            for i in (-1, *self._joints)
        ]
        return float(sum(row[0] for row in rows))

    def _pose(self, T_world_torso: Matrix, angles_rad: NDArray[np.float64]) -> None:
        T = T_world_torso @ self._T_torso_inertial
        pybullet.resetBasePositionAndOrientation(
            self._robot, T[:3, 3].tolist(), quat_xyzw(T[:3, :3]).tolist(),
            physicsClientId=self._client,
        )  # fmt: skip
        # hands are a fraction of their opening: the fingers are drawn where they are when closed
        turned = angles_rad * _NO_HANDS
        pybullet.resetJointStatesMultiDof(
            self._robot, self._joints, [[value] for value in turned.tolist()],
            physicsClientId=self._client,
        )  # fmt: skip

    def link_frames(
        self, T_world_torso: Matrix, angles_rad: NDArray[np.float64]
    ) -> dict[str, Matrix]:
        """Frames of all links in the world, (4, 4) each, for a torso pose and angles (26,).

        Raises BackendError once closed.
        """
        with self._lock:
            if self._client < 0:
                raise BackendError("the simulation has been closed")
            self._pose(T_world_torso, angles_rad)
            states = pybullet.getLinkStates(
                self._robot,
                self._joints,
                computeForwardKinematics=1,
                physicsClientId=self._client,
            )
        frames = {"torso": T_world_torso.copy()}
        for name, state in zip(LINK_NAMES[1:], states, strict=True):
            frames[name] = _matrix(state[4], state[5])
        return frames

    def close(self) -> None:
        """Let go of the physics server. May be called twice."""
        with self._lock:
            if self._client >= 0:
                pybullet.disconnect(physicsClientId=self._client)
                self._client = -1


_T_LINK_SHAPE = np.stack([shape.T_link_shape for shape in SHAPES])


def shape_frames(frames: dict[str, Matrix]) -> NDArray[np.float64]:
    """Poses of all `SHAPES` in the world, (n, 4, 4), from the links' frames."""
    return np.stack([frames[shape.link] for shape in SHAPES]) @ _T_LINK_SHAPE


def _matrix(position: tuple[float, ...], quat: tuple[float, ...]) -> Matrix:
    rows = pybullet.getMatrixFromQuaternion(quat)
    return transform(np.array(rows).reshape(3, 3), np.array(position))
