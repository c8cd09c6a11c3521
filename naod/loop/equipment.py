"""What the step works with and never changes: configuration, camera, body, object, estimators."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hal.nao.joints import JOINT_INDEX
from hal.types import BodyState, CameraName, Frame, HeadAngles, PlanarMotion, RobotInfo
from naod.config import CameraConfig, DaemonConfig
from naod.finding.find import find_object
from naod.finding.hue import Colours
from naod.geometry.camera import PinholeCamera, nominal_camera
from naod.geometry.transforms import Matrix, Vector
from naod.localisation.base_frame import T_base_camera, is_lifted
from naod.localisation.body_model import BodyFrames, BodyModel
from naod.localisation.camera_motion import CameraMotion, camera_motion, motion_px
from naod.localisation.ego import EgoPose, ego_pose
from naod.localisation.looks import Look
from naod.localisation.placement import Placement, placed
from naod.messages import WalkState
from naod.perception.blob import Blob
from naod.perception.colour_model import ColourModel
from naod.perception.segmenter import Segmentation, Segmenter
from naod.pose.locate import locate
from naod.pose.objects import ObjectShape
from naod.pose.prior import Prior
from naod.pose.result import Estimator, ObjectPose

NEAREST_M = 0.1
AHEAD = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True)
class Sighting:
    """The object in one picture, all the way to the base frame.

    `ray_in_camera`: (3,) towards the blob's centre. `look` and `placement` are None when no pose
    could be had: the outline is cut off, or the feet do not say where the ground is. `blur_px`: how
    far the object moved through the picture during its exposure. `probability`: that it is it.
    `expected`: where it was looked for.
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
    placement: Placement | None = None
    blur_px: float = 0.0
    probability: float = 1.0
    expected: Prior | None = None


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

    def T_base_camera(self, body: BodyState) -> Matrix | None:
        """The camera in the base frame; None while the feet do not stand."""
        return _on_feet(self.body.frames(body.angles_rad), body)

    def motion(
        self, around: tuple[BodyState, BodyState] | None, walk: WalkState
    ) -> CameraMotion | None:
        """How the camera moved between two states of the body, if they are known."""
        if around is None:
            return None
        return camera_motion(self.body, *around, PlanarMotion(*walk.velocity))

    def sight(
        self,
        model: ColourModel,
        frame: Frame,
        body: BodyState,
        prior: Prior | None = None,
        motion: CameraMotion | None = None,
    ) -> Sighting | None:
        """Find and localise the object in a frame; None when it is not seen."""
        segmentation = self._segmenter_for(model).segment(frame.yuyv)
        settings = self.config.segmentation
        expected_px = self._blur_px(frame, _point(AHEAD, None, prior), motion)
        colours = Colours(frame.yuyv, model)
        found = find_object(
            segmentation, self.shape, self.camera, prior, settings, expected_px, colours
        )
        if found is None:
            return None
        blob = found.blob
        ray = np.append(self.camera.normalised(np.array([blob.centre_px]))[0], 1.0)
        pose = self._locate(frame, blob, self.config.approach.estimator, prior)
        blur_px = self._blur_px(frame, _point(ray, pose, prior), motion)
        edges_blur_px = pose.blur_px if pose else 0.0
        frames = self.body.frames(body.angles_rad)
        T = _on_feet(frames, body)
        placement = None
        if pose is not None and T is not None:
            placement = placed(frame.stamp_ns, pose, T, motion, blur_px, edges_blur_px)
        return Sighting(
            stamp_ns=frame.stamp_ns,
            blob=blob,
            segmentation=segmentation,
            ray_in_camera=ray,
            head=head_angles(body),
            T_torso_camera=frames.T_torso_camera,
            pose=pose,
            look=placement.look() if placement else None,
            paper=self._printed(frame, blob, T, prior),
            placement=placement,
            blur_px=max(blur_px, edges_blur_px),
            probability=found.probability,
            expected=prior,
        )

    def _blur_px(self, frame: Frame, point: Vector, motion: CameraMotion | None) -> float:
        if motion is None:
            return 0.0
        return math.hypot(*motion_px(motion, point, self.camera, frame.exposure_s))

    def _printed(
        self, frame: Frame, blob: Blob, T: Matrix | None, prior: Prior | None
    ) -> EgoPose | None:
        if T is None or not self.compare_paper:
            return None
        printed = self._locate(frame, blob, "paper", prior)
        return ego_pose(T @ printed.T_camera_object) if printed else None

    def _locate(
        self, frame: Frame, blob: Blob, estimator: Estimator, near: Prior | None
    ) -> ObjectPose | None:
        return locate(
            frame.yuyv, blob, self.shape, self.camera, estimator, near, exposure_s=frame.exposure_s
        )

    def _segmenter_for(self, model: ColourModel) -> Segmenter:
        if self._segmenter is None:
            size = (self.camera.width, self.camera.height)
            self._segmenter = (model, Segmenter(model, self.config.segmentation, size))
        elif self._segmenter[0] is not model:
            # in changing light there is another every few seconds
            self._segmenter[1].take(model)
            self._segmenter = (model, self._segmenter[1])
        return self._segmenter[1]


def _on_feet(frames: BodyFrames, body: BodyState) -> Matrix | None:
    return None if is_lifted(body.foot_load_kg) else T_base_camera(frames, body.foot_load_kg)


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


def _point(ray: Vector, pose: ObjectPose | None, prior: Prior | None) -> Vector:
    """Where the object is in the camera, (3,): as seen, else as expected, else a metre away."""
    if pose is not None:
        return pose.T_camera_object[:3, 3]
    return ray if prior is None else ray * max(float(prior.T_camera_object[2, 3]), NEAREST_M)
