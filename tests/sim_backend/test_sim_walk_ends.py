"""How a motion ends: by its deadline, a stop, a fall; and what is refused."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest
from sim_world import CALM, Opened, base, run, until_standing

from hal.errors import MotionRefusedError
from hal.types import HeadAngles, PlanarMotion


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_refused(opened: Opened, bad: float) -> None:
    robot = opened()
    for motion in (PlanarMotion(bad, 0, 0), PlanarMotion(0, bad, 0), PlanarMotion(0, 0, bad)):
        with pytest.raises(MotionRefusedError, match="not finite"):
            robot.walk.move_to(motion, 1.0)
        with pytest.raises(MotionRefusedError, match="not finite"):
            robot.walk.set_velocity(motion, 1.0)
    for valid in (bad, 0.0, -1.0):
        with pytest.raises(MotionRefusedError, match="validity"):
            robot.walk.set_velocity(PlanarMotion(0.05, 0, 0), valid)
    assert not robot.walk.status().moving


def test_a_refused_motion_leaves_the_present_one(opened: Opened) -> None:
    robot = opened()
    robot.walk.set_velocity(PlanarMotion(0.05, 0.0, 0.0), 5.0)
    with pytest.raises(MotionRefusedError):
        robot.walk.set_velocity(PlanarMotion(math.nan, 0.0, 0.0), 5.0)
    assert robot.walk.status().velocity == PlanarMotion(0.05, 0.0, 0.0)


@pytest.mark.parametrize("walked_s", [0.1, 0.5, 0.85, 1.0, 1.25, 2.0, 2.13, 2.4, 3.01])
def test_a_motion_not_renewed_ends_by_itself(opened: Opened, walked_s: float) -> None:
    robot = opened()
    robot.walk.set_velocity(PlanarMotion(0.08, 0.02, 0.2), walked_s)
    run(robot, walked_s + 0.02)
    assert robot.walk.status().velocity == PlanarMotion(0.0, 0.0, 0.0)
    assert until_standing(robot) < 1.2
    still = base(robot)
    run(robot, 1.0)
    assert base(robot) == still


def test_a_motion_renewed_goes_on(opened: Opened) -> None:
    robot = opened()
    robot.walk.set_velocity(PlanarMotion(0.08, 0.0, 0.0), 0.3)
    for _ in range(20):
        run(robot, 0.2)
        robot.walk.renew(0.3)
    assert robot.walk.status().velocity.x == 0.08
    run(robot, 0.32)
    assert robot.walk.status().velocity.x == 0.0


def test_renewing_what_has_ended_starts_nothing(opened: Opened) -> None:
    robot = opened()
    robot.walk.renew(5.0)
    robot.walk.set_velocity(PlanarMotion(0.08, 0.0, 0.0), 0.3)
    run(robot, 0.4)
    robot.walk.renew(5.0)
    run(robot, 2.0)
    assert not robot.walk.status().moving


@pytest.mark.parametrize("walked_s", [0.3, 0.9, 1.3, 1.7, 2.2])
def test_stop_ends_on_parallel_feet_within_its_time(opened: Opened, walked_s: float) -> None:
    robot = opened()
    robot.walk.move_to(PlanarMotion(1.0, 0.2, 0.5), 60.0)
    run(robot, walked_s)
    robot.walk.stop()
    assert robot.walk.status().velocity == PlanarMotion(0.0, 0.0, 0.0)
    assert until_standing(robot) < 1.2
    state = robot.body.latest()
    assert state.angles_rad[8:14] == pytest.approx(CALM_LEGS, abs=0.004)


CALM_LEGS = [0.0, 0.0, -0.45, 0.7, -0.35, 0.0]


def test_a_new_command_is_felt_after_the_preview(opened: Opened) -> None:
    robot = opened()
    robot.walk.set_velocity(PlanarMotion(0.08, 0.0, 0.0), 60.0)
    run(robot, 3.0)
    robot.walk.set_velocity(PlanarMotion(-0.08, 0.0, 0.0), 60.0)
    at_command = base(robot)[0]
    run(robot, 0.4)
    assert base(robot)[0] > at_command
    run(robot, 2.5)
    assert base(robot)[0] < at_command


def test_a_fallen_robot_refuses_and_lies(opened: Opened) -> None:
    robot = opened()
    robot.knock_over()
    run(robot, 1.0)
    status = robot.walk.status()
    assert status.fallen
    assert not status.moving
    for refused in (
        lambda: robot.walk.move_to(PlanarMotion(0.1, 0, 0), 1.0),
        lambda: robot.walk.set_velocity(PlanarMotion(0.1, 0, 0), 1.0),
        lambda: robot.head.look(HeadAngles(0.1, 0.0), 1.0),
    ):
        with pytest.raises(MotionRefusedError, match="fallen"):
            refused()
    state = robot.body.latest()
    assert sum(state.foot_load_kg) < 0.2
    assert abs(state.torso_roll_pitch_rad[1]) > 1.2
    assert robot.truth().T_world_camera[2, 3] < 0.2
    robot.place(PlanarMotion(0.0, 0.0, 0.0))
    assert not robot.walk.status().fallen
    robot.walk.move_to(PlanarMotion(0.1, 0.0, 0.0), 10.0)


@pytest.mark.parametrize(("push", "falls"), [(1.5, False), (2.5, True)])
def test_a_push_moves_it_or_fells_it(opened: Opened, push: float, falls: bool) -> None:
    pushed = msgspec.structs.replace(CALM.walk, push=push)
    robot = opened(msgspec.structs.replace(CALM, walk=pushed))
    robot.walk.move_to(PlanarMotion(0.3, 0.0, 0.0), 60.0)
    until_standing(robot)
    assert robot.walk.status().fallen is falls
    if not falls:
        assert base(robot)[1] == pytest.approx(0.03, abs=1e-3)


def test_put_down_somewhere_it_stands_there_with_its_past_forgotten(opened: Opened) -> None:
    robot = opened()
    robot.head.look(HeadAngles(0.8, 0.1), 3.0)
    robot.walk.set_velocity(PlanarMotion(0.08, 0.0, 0.1), 60.0)
    run(robot, 3.0)
    before = robot.clock.now_ns()
    robot.place(PlanarMotion(0.5, -0.3, 2.0))
    assert base(robot) == pytest.approx((0.5, -0.3, 2.0))
    assert not robot.walk.status().moving
    assert robot.body.at(before - 500_000_000) is None
    assert robot.camera.latest(10.0) is None
    assert robot.body.latest().angles_rad[:2] == pytest.approx((0.0, 0.0), abs=0.004)
    run(robot, 1.0)
    assert base(robot) == pytest.approx((0.5, -0.3, 2.0))
    assert np.abs(robot.body.latest().gyro_rad_s).max() < 0.05
