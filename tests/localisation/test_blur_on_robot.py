"""Predicted blur against the simulator's truth: a head that turns, a robot that walks."""

import math
from pathlib import Path

import numpy as np
import pytest

from hal.backends import OpenOptions, open_robot
from hal.scenario import CameraSection, Scenario, SceneSection
from hal.types import HeadAngles, PlanarMotion
from naod.geometry.camera import nominal_camera
from naod.geometry.transforms import inverse
from naod.localisation.body_model import BodyModel
from naod.localisation.camera_motion import camera_motion, motion_px
from naod.loop.around import around

CAMERA = nominal_camera("v6", 160, 120)
MODEL = BodyModel("v6", "top")
LATENCY_S = 0.03
DARK = Scenario(scene=SceneSection(light=0.3), camera=CameraSection(latency_s=LATENCY_S))
FRAMES = 16


@pytest.fixture
def robot():
    section = {"scenario": DARK, "scenario_folder": Path(), "seed": 2, "real_time": False}
    opened = open_robot("sim", OpenOptions(width=160, height=120, section=section))
    yield opened
    opened.close()


def object_in_camera(truth):
    return (inverse(truth.T_world_camera) @ truth.T_world_object)[:3, 3]


def one_frame(robot):
    """Predicted and true motion of the object through the next picture, px of this camera."""
    frame = robot.camera.next(1.0)
    period_ns, half_ns = 2 * round(1e9 / 15), round(0.5e9 * frame.exposure_s)
    middle_ns = frame.stamp_ns + period_ns
    seen = []
    for at_ns in (middle_ns - half_ns, middle_ns, middle_ns + half_ns):
        robot.advance(at_ns)
        seen.append(object_in_camera(robot.truth()))
    robot.advance(middle_ns + half_ns + round(LATENCY_S * 1e9) + 1_000_000)
    frame = robot.camera.latest(0.5)
    assert abs(frame.stamp_ns - middle_ns) < 1000
    walking = robot.walk.status().velocity
    motion = camera_motion(MODEL, *around(robot.body, frame), walking)
    predicted = motion_px(motion, seen[1], CAMERA, frame.exposure_s)
    first, last = CAMERA.project(np.array([seen[0], seen[2]]))
    return predicted, last - first


def measured(robot, each):
    rows = []
    for n in range(FRAMES):
        each(n)
        rows.append(one_frame(robot))
    predicted, true = (np.array(part) for part in zip(*rows, strict=True))
    return predicted, true


def test_a_head_that_turns_blurs_as_predicted(robot):
    def swing(n):
        robot.head.look(HeadAngles(math.copysign(0.4, (n % 4) - 1.5), 0.1 * (n % 3)), 1.5)

    predicted, true = measured(robot, swing)
    assert np.hypot(*true.T).max() > 5.0
    error = np.hypot(*(predicted - true).T)
    assert np.median(error) < 0.15
    assert error.max() < 1.0


def test_a_robot_that_stands_is_not_said_to_blur(robot):
    predicted, true = measured(robot, lambda n: None)
    assert np.hypot(*true.T).max() < 1e-6
    assert np.hypot(*predicted.T).max() < 0.3


def test_a_robot_that_walks_blurs_about_as_predicted(robot):
    """Between the feet's own motions, which nobody measures."""
    velocity = PlanarMotion(0.0, 0.05, 0.3)
    predicted, true = measured(robot, lambda n: robot.walk.set_velocity(velocity, 1.0))
    error, blur = np.hypot(*(predicted - true).T), np.hypot(*true.T)
    assert blur.max() > 3.0
    assert np.median(error) < 0.25 * np.median(blur[blur > 1.0])
    assert error.max() < 0.5 * blur.max()
