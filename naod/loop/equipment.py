"""What the step works with and never changes: configuration, camera, body, object, estimators."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hal.nao.joints import JOINT_INDEX
from hal.types import BodyState, CameraName, Frame, HeadAngles, RobotInfo
from naod.config import CameraConfig, DaemonConfig
from naod.geometry.camera import PinholeCamera, nominal_camera
from naod.geometry.transforms import Matrix, Vector
from naod.localisation.base_frame import T_base_camera, is_lifted
from naod.localisation.body_model import BodyModel
from naod.localisation.ego import EgoPose, cartesian_jacobian, ego_pose
from naod.localisation.looks import Look, with_body_error
from naod.perception.blob import Blob, find_blob
from naod.perception.colour_model import ColourModel
from naod.perception.segmenter import Segmentation, Segmenter
from naod.pose.locate import locate
from naod.pose.objects import ObjectShape
from naod.pose.result import Estimator, ObjectPose


@dataclass(frozen=True, slots=True)
class Sighting:
    """The object in one picture, all the way to the base frame.

    `ray_in_camera`: (3,) towards the blob's centre. `look` is None when no pose could be had: the
    outline is cut off, or the feet do not say where the ground is.
    """

    stamp_ns: int
    blob: Blob
    segmentation: Segmentation
    ray_in_camera: Vector
    head: HeadAngles
    T_torso_camera: Matrix
    pose: ObjectPose | None
    look: Look | None
    paper: EgoPose | None


class Equipment:
    """Immutable settings plus scratch memory; `sight` is a function of its arguments."""

    def __init__(
        self,
        config: DaemonConfig,
        camera: PinholeCamera,
        body: BodyModel,
        shape: ObjectShape,
        compare_paper: bool = False,
    ) -> None:
        self.config = config
        self.camera = camera
        self.body = body
        self.shape = shape
        self.compare_paper = compare_paper
        self._segmenter: tuple[ColourModel, Segmenter] | None = None

    @staticmethod
    def from_config(
        config: DaemonConfig, info: RobotInfo, shape: ObjectShape, compare_paper: bool = False
    ) -> Equipment:
        """Equipment for a robot, with nominal intrinsics where none are configured."""
        camera = camera_of(config.camera, info)
        roll, pitch, yaw = (math.radians(v) for v in config.camera.correction_deg)
        body = BodyModel(info.version, config.camera.which, (roll, pitch, yaw))
        return Equipment(config, camera, body, shape, compare_paper)

    @property
    def camera_name(self) -> CameraName:
        """Which of the head's cameras."""
        return self.config.camera.which

    def sight(self, model: ColourModel, frame: Frame, body: BodyState) -> Sighting | None:
        """Find and localise the object in a frame; None when it is not seen."""
        segmentation = self._segmenter_for(model).segment(frame.yuyv)
        blob = find_blob(segmentation, self.config.segmentation.pixels_min)
        if blob is None:
            return None
        frames = self.body.frames(body.angles_rad)
        ray = np.append(self.camera.normalised(np.array([blob.centre_px]))[0], 1.0)
        estimator = self.config.approach.estimator
        pose = self._locate(frame, blob, estimator)
        look, paper = None, None
        if not is_lifted(body.foot_load_kg):
            T = T_base_camera(frames, body.foot_load_kg)
            look = _look(frame.stamp_ns, pose, T) if pose else None
            printed = self._locate(frame, blob, "paper") if self.compare_paper else None
            paper = ego_pose(T @ printed.T_camera_object) if printed else None
        return Sighting(
            stamp_ns=frame.stamp_ns,
            blob=blob,
            segmentation=segmentation,
            ray_in_camera=ray,
            head=head_angles(body),
            T_torso_camera=frames.T_torso_camera,
            pose=pose,
            look=look,
            paper=paper,
        )

    def _locate(self, frame: Frame, blob: Blob, estimator: Estimator) -> ObjectPose | None:
        return locate(frame.yuyv, blob, self.shape, self.camera, estimator)

    def _segmenter_for(self, model: ColourModel) -> Segmenter:
        if self._segmenter is None or self._segmenter[0] is not model:
            size = (self.camera.width, self.camera.height)
            self._segmenter = (model, Segmenter(model, self.config.segmentation, size))
        return self._segmenter[1]


def head_angles(body: BodyState) -> HeadAngles:
    """The measured angles of the neck."""
    yaw = float(body.angles_rad[JOINT_INDEX["HeadYaw"]])
    return HeadAngles(yaw, float(body.angles_rad[JOINT_INDEX["HeadPitch"]]))


def camera_of(config: CameraConfig, info: RobotInfo) -> PinholeCamera:
    """Configured intrinsics over the nominal ones of the robot's version."""
    nominal = nominal_camera(info.version, config.width, config.height)
    return PinholeCamera(
        width=config.width,
        height=config.height,
        fx=config.fx or nominal.fx,
        fy=config.fy or nominal.fy,
        cx=nominal.cx if config.cx is None else config.cx,
        cy=nominal.cy if config.cy is None else config.cy,
        distortion=config.distortion,
    )


def _look(stamp_ns: int, pose: ObjectPose, T: Matrix) -> Look | None:
    """The pose carried into the base frame (equations 6 and 7), with its uncertainty."""
    T_base_object = T @ pose.T_camera_object
    ego = ego_pose(T_base_object)
    J = cartesian_jacobian(T_base_object, T)
    covariance = with_body_error(J @ pose.covariance @ J.T, ego)
    finite = np.isfinite(covariance).all() and np.isfinite(T_base_object).all()
    return Look(stamp_ns, ego, covariance) if finite else None
