"""A calm world, and small things to do in it."""

from __future__ import annotations

from collections.abc import Callable

import msgspec

from hal.scenario import CameraSection, Scenario, WalkSection
from sim_backend.backend import SimRobot

Opened = Callable[..., SimRobot]

CALM = Scenario(walk=WalkSection(slip_std=0.0, yaw_drift=0.0))
TICK_S = 0.01


def with_camera(**figures) -> Scenario:
    """A calm scenario with another camera section."""
    return msgspec.structs.replace(CALM, camera=CameraSection(**figures))


def run(robot: SimRobot, seconds: float) -> None:
    """Let the world run."""
    robot.advance(robot.clock.now_ns() + round(seconds * 1e9))


def until_standing(robot: SimRobot, limit_s: float = 60.0) -> float:
    """Let the world run until the robot stands; how long that took, in s."""
    begin = robot.clock.now_ns()
    while robot.walk.status().moving:
        run(robot, TICK_S)
        assert robot.clock.now_ns() - begin < limit_s * 1e9
    return (robot.clock.now_ns() - begin) / 1e9


def base(robot: SimRobot) -> tuple[float, float, float]:
    """The true base in the world."""
    pose = robot.truth().base
    return (pose.x, pose.y, pose.yaw)
