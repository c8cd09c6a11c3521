"""The whole calibration with a robot: find the rectangle, go through head poses, fit."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from hal.errors import MotionRefusedError
from hal.protocols import Robot
from hal.types import HeadAngles, NaoVersion
from naod.calibration.eyes import Eyes
from naod.calibration.fit import Expected, Problem, first_estimate, fit, without_odd_views
from naod.calibration.plan import grid, head_poses, rows_of
from naod.calibration.record import Recorded, Recorder, Tell
from naod.calibration.result import VIEWS_MIN, Calibration, CalibrationError, calibration
from naod.calibration.rig import Rig
from naod.config import CameraConfig, DaemonConfig
from naod.geometry.camera import PinholeCamera
from naod.geometry.transforms import Vector, inverse
from naod.localisation.base_frame import T_torso_base
from naod.localisation.body_model import BodyModel
from naod.loop.equipment import camera_of, head_angles
from naod.perception.colour_model import ColourModel
from naod.pose.objects import Rectangle

VIEWS = 16
NEAR = 0.5
"""Share of the picture that the first few views keep to."""

STAND_UP_S = 60.0
MOVES = "the robot moves"
POLL_S, STILL_S, MOVING_RAD = 0.1, 1.0, 0.01
"""Still is who has moved no joint by more than that from poll to poll for so long."""


@dataclass(frozen=True, slots=True)
class Wanted:
    """How to go about it. `by_hand`: a person turns the head. `lens`: fit the intrinsics too."""

    views: int = VIEWS
    by_hand: bool = False
    lens: bool = True


def calibrate(
    robot: Robot,
    config: DaemonConfig,
    model: ColourModel,
    shape: Rectangle,
    wanted: Wanted,
    tell: Tell,
) -> Calibration:
    """Calibrate the camera of a robot that stands and sees the rectangle.

    The head is turned back at the end. Raises CalibrationError, InputError, HalError.
    """
    camera = camera_of(config.camera, robot.info)
    eyes = Eyes(config, model, shape, camera)
    recorder = Recorder(robot, eyes, tell)
    if wanted.by_hand:
        tell(f"hold the head still in {wanted.views} poses, the rectangle wholly in view")
        recorded = recorder.by_hand(wanted.views)
        return evaluated(recorded, config.camera, robot.info.version, camera, shape, wanted.lens)
    before = await_obedience(robot, tell)
    try:
        recorded = _driven(recorder, config.camera, camera, shape, wanted.views)
    finally:
        robot.head.look(before, 0.5)
    return evaluated(recorded, config.camera, robot.info.version, camera, shape, wanted.lens)


def await_obedience(robot: Robot, tell: Tell) -> HeadAngles:
    """Wait until the robot is still and its head may be turned: it may have to stand up first.

    Returns where the head is. Raises MotionRefusedError with the robot's reason when it does not
    come to that.
    """
    clock, told, still_polls = robot.clock, "", 0
    give_up_ns = clock.now_ns() + round(STAND_UP_S * 1e9)
    before = robot.body.latest().angles_rad
    while True:
        clock.sleep_until(clock.now_ns() + round(POLL_S * 1e9))
        body = robot.body.latest()
        is_still = float(np.abs(body.angles_rad - before).max()) < MOVING_RAD
        still_polls, before = still_polls + 1 if is_still else 0, body.angles_rad
        head = head_angles(body)
        try:
            robot.head.look(head, 0.5)
            if still_polls * POLL_S >= STILL_S:
                return head
            why = MOVES
        except MotionRefusedError as error:
            why = str(error)
        if clock.now_ns() > give_up_ns:
            raise MotionRefusedError(why)
        if why not in (told, MOVES):
            told = why
            tell(f"waiting: {told}")


def _driven(
    recorder: Recorder,
    config: CameraConfig,
    camera: PinholeCamera,
    shape: Rectangle,
    views: int,
) -> Recorded:
    """A few views about the middle say how the camera sits, roughly; then all over the picture."""
    first = recorder.here()
    if isinstance(first, str):
        raise CalibrationError(f"the rectangle is not found: {first}")
    rig, correction, lens = _start(config, camera)
    size = (camera.width, camera.height)
    corners = first[0].edges.points_px
    at = first_estimate(rig, [first[0]], correction, lens)
    near = recorder.through(head_poses(rig, at, shape, grid(corners, size, 2, 2, NEAR), size))
    if len(near.views) >= 3:
        expected = Expected.of(lens, camera.width, known=True)
        at = first_estimate(rig, near.views, correction, lens)
        at = fit(Problem(rig, shape, near.views, expected), at).estimate
        at = replace(at, heads_rad=np.zeros((1, 2)))
    places = grid(corners, size, *rows_of(views - 4))
    far = recorder.through(head_poses(rig, at, shape, places, size))
    return Recorded(near.views + far.views, near.bodies + far.bodies)


def evaluated(
    recorded: Recorded,
    config: CameraConfig,
    version: NaoVersion,
    camera: PinholeCamera,
    shape: Rectangle,
    lens: bool,
) -> Calibration:
    """Fit what was recorded. Raises CalibrationError, InputError."""
    views = recorded.views
    if len(views) < VIEWS_MIN:
        raise CalibrationError(
            f"the rectangle was seen in {len(views)} head poses, {VIEWS_MIN} are needed: "
            "put it where the head can turn about it, well lit, in one plain colour"
        )
    base = T_torso_base(
        BodyModel(version).frames(recorded.standing()), recorded.bodies[0].foot_load_kg
    )
    rig, correction, start = _start(config, camera)
    expected = Expected.of(start, camera.width, not lens)
    at = first_estimate(rig, views, correction, start)
    fitted, kept = without_odd_views(rig, shape, views, expected, at)
    if len(kept) < VIEWS_MIN:
        raise CalibrationError(
            f"only {len(kept)} of {len(views)} views go together: "
            "the rectangle or the robot has moved"
        )
    left_out = len(views) - len(kept)
    T_base_object = inverse(base) @ fitted.estimate.T_torso_object
    size = (camera.width, camera.height)
    return calibration(fitted, rig, size, len(kept), left_out, T_base_object)


def _start(config: CameraConfig, camera: PinholeCamera) -> tuple[Rig, Vector, Vector]:
    k1, *others = (float(v) for v in camera.distortion_array)
    lens = np.array([camera.fx, camera.fy, camera.cx, camera.cy, k1])
    correction = np.array([math.radians(v) for v in config.correction_deg])
    return Rig(config.which, np.array(others)), correction, lens
