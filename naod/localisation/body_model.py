"""Forward kinematics of the NAO with pinocchio, from the published figures in `hal.nao`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from hal.nao.cameras import MOUNTS
from hal.nao.feet import SOLE_IN_ANKLE_M
from hal.nao.joints import JOINT_INDEX, JOINTS, Joint
from hal.nao.links import Link, links
from hal.types import CameraName, NaoVersion
from naod.geometry.transforms import (
    R_CAMERABODY_OPTICAL,
    Matrix,
    rot_x,
    rot_y,
    rot_z,
    transform,
)

_ROOT_LINK = "torso"
_SOLES = {"l_sole": "l_ankle", "r_sole": "r_ankle"}


@dataclass(frozen=True, slots=True)
class BodyFrames:
    """Frames of the body in the torso for one posture, (4, 4) each."""

    T_torso_camera: Matrix
    T_torso_lsole: Matrix
    T_torso_rsole: Matrix


class BodyModel:
    """Kinematic model of one robot with one of its cameras.

    `correction_rad`: roll, pitch and yaw about the camera's body axes (x forward, y left, z up)
    that turn the nominal mounting into this head's real one.
    """

    def __init__(
        self,
        version: NaoVersion,
        camera: CameraName = "top",
        correction_rad: tuple[float, float, float] = (0.0, 0.0, 0.0),
    ) -> None:
        self.T_head_camera = T_head_camera(camera, correction_rad)
        self._torso = links(version)[_ROOT_LINK]
        self.model, self._q_index = _build(version, self.T_head_camera)
        self._data = self.model.createData()
        self._frame_ids = {
            name: self.model.getFrameId(name) for name in ("camera", "l_sole", "r_sole")
        }

    def frames(self, angles_rad: NDArray[np.float64]) -> BodyFrames:
        """Frames for joint angles (26,), order of `JOINT_NAMES`."""
        q = np.asarray(angles_rad, dtype=np.float64)[self._q_index]
        pin.framesForwardKinematics(self.model, self._data, q)
        return BodyFrames(
            self._placement("camera"), self._placement("l_sole"), self._placement("r_sole")
        )

    def centre_of_mass(self, angles_rad: NDArray[np.float64]) -> NDArray[np.float64]:
        """(3,) centre of mass in the torso, metres."""
        q = np.asarray(angles_rad, dtype=np.float64)[self._q_index]
        # pinocchio leaves out what is fixed to its universe, which here is the torso
        moving = np.array(pin.centerOfMass(self.model, self._data, q))
        moving_kg, torso = float(self._data.mass[0]), self._torso
        total = moving_kg * moving + torso.mass_kg * np.array(torso.com_m)
        return np.asarray(total / (moving_kg + torso.mass_kg), dtype=np.float64)

    def _placement(self, name: str) -> Matrix:
        return np.array(self._data.oMf[self._frame_ids[name]].homogeneous)


def T_head_camera(camera: CameraName, correction_rad: tuple[float, float, float]) -> Matrix:
    """The optical frame of a camera in the Head link, with a correction (`nao_cameras.yaml`)."""
    mount = MOUNTS[camera]
    roll, pitch, yaw = correction_rad
    R_correction = rot_z(yaw) @ rot_y(pitch) @ rot_x(roll)
    R = rot_y(mount.pitch_down_rad) @ R_correction @ R_CAMERABODY_OPTICAL
    return transform(R, mount.origin_m)


def _build(version: NaoVersion, T_camera: Matrix) -> tuple[pin.Model, NDArray[np.intp]]:
    """The model, and for each of its coordinates the index in `JOINT_NAMES`."""
    model = pin.Model()
    bodies = links(version)
    joint_of_link = {_ROOT_LINK: 0}
    moving = [joint for joint in JOINTS if joint.child in bodies]
    for joint in moving:
        joint_of_link[joint.child] = _add_joint(model, joint, joint_of_link[joint.parent], bodies)
    _add_frame(model, "camera", joint_of_link["Head"], T_camera)
    for sole, ankle in _SOLES.items():
        _add_frame(model, sole, joint_of_link[ankle], transform(np.eye(3), SOLE_IN_ANKLE_M))
    index = np.empty(model.nq, dtype=np.intp)
    for joint in moving:
        index[model.joints[joint_of_link[joint.child]].idx_q] = JOINT_INDEX[joint.name]
    return model, index


def _add_joint(model: pin.Model, joint: Joint, parent: int, bodies: dict[str, Link]) -> int:
    axis = np.array(joint.axis) / np.linalg.norm(joint.axis)
    placement = pin.SE3(np.eye(3), np.array(joint.origin_m))
    number = model.addJoint(parent, pin.JointModelRevoluteUnaligned(axis), placement, joint.name)
    model.appendBodyToJoint(number, _inertia(bodies[joint.child]), pin.SE3.Identity())
    return int(number)


def _add_frame(model: pin.Model, name: str, joint: int, T_joint_frame: Matrix) -> None:
    placement = pin.SE3(T_joint_frame[:3, :3], T_joint_frame[:3, 3])
    model.addFrame(pin.Frame(name, joint, placement, pin.FrameType.OP_FRAME))


def _inertia(link: Link) -> pin.Inertia:
    ixx, ixy, ixz, iyy, iyz, izz = link.inertia_kg_m2
    tensor = np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
    return pin.Inertia(link.mass_kg, np.array(link.com_m), tensor)
