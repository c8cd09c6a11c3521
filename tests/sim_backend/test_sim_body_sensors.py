"""What the body's sensors say, against what the body does."""

from __future__ import annotations

import math

import numpy as np
import pytest
from sim_world import Opened, base, run, until_standing

from hal.errors import MotionRefusedError
from hal.nao.head_limits import HEAD_SPEED_MAX_RAD_S, pitch_range_rad
from hal.nao.joints import ENCODER_STEP_RAD, JOINT_INDEX
from hal.types import HeadAngles, PlanarMotion

YAW, PITCH = JOINT_INDEX["HeadYaw"], JOINT_INDEX["HeadPitch"]


def test_standing_still_it_feels_its_weight_and_no_motion(opened: Opened) -> None:
    robot = opened()
    states = []
    for _ in range(100):
        run(robot, 0.01)
        states.append(robot.body.latest())
    assert np.mean([sum(state.foot_load_kg) for state in states]) == pytest.approx(5.36, abs=0.05)
    assert np.linalg.norm(np.mean([s.accel_m_s2 for s in states], axis=0)) == pytest.approx(
        9.81, abs=0.05
    )
    assert np.mean([s.gyro_rad_s for s in states], axis=0) == pytest.approx(0.0, abs=0.005)
    tilt = np.mean([s.torso_roll_pitch_rad for s in states], axis=0)
    assert tilt == pytest.approx((0.0, 0.1), abs=0.002)
    stamps = np.array([state.stamp_ns for state in states])
    assert (np.diff(stamps) == 10_000_000).all()


def test_angles_come_in_the_encoders_steps_and_lie_near_the_truth(opened: Opened) -> None:
    robot = opened()
    run(robot, 0.5)
    state = robot.body.latest()
    steps = state.angles_rad / ENCODER_STEP_RAD
    assert steps == pytest.approx(np.rint(steps), abs=1e-6)
    truth = robot._world.snapshot(state.stamp_ns)
    assert state.angles_rad == pytest.approx(truth.angles_rad, abs=0.003)


def test_the_gyro_adds_up_to_the_turn(opened: Opened) -> None:
    robot = opened()
    begin, turned = base(robot)[2], 0.0
    robot.walk.move_to(PlanarMotion(0.0, 0.0, 1.0), 60.0)
    while robot.walk.status().moving:
        run(robot, 0.01)
        state = robot.body.latest()
        roll, pitch = state.torso_roll_pitch_rad
        rate = state.gyro_rad_s[1] * math.sin(roll) + state.gyro_rad_s[2] * math.cos(roll)
        turned += 0.01 * rate / math.cos(pitch)
    assert turned == pytest.approx(base(robot)[2] - begin, abs=0.03)


def test_a_moment_between_two_measurements_is_interpolated(opened: Opened) -> None:
    robot = opened()
    robot.head.look(HeadAngles(1.0, 0.0), 2.0)
    run(robot, 0.2)
    before, after = robot.body.at(150_000_000), robot.body.at(160_000_000)
    middle = robot.body.at(155_000_000)
    assert middle.stamp_ns == 155_000_000
    assert middle.angles_rad == pytest.approx((before.angles_rad + after.angles_rad) / 2.0)
    assert robot.body.at(robot.clock.now_ns() + 1) is None
    assert robot.body.at(-1) is None


def test_the_head_turns_at_its_speed_and_stops_at_its_range(opened: Opened) -> None:
    robot = opened()
    assert robot.head.look(HeadAngles(9.0, 9.0), 1.0).yaw_rad == pytest.approx(2.08567)
    run(robot, 1.0)
    assert robot.body.latest().angles_rad[YAW] == pytest.approx(1.0, abs=0.04)
    run(robot, 2.0)
    yaw, pitch = robot.body.latest().angles_rad[[YAW, PITCH]]
    assert yaw == pytest.approx(2.08567, abs=0.003)
    assert pitch == pytest.approx(pitch_range_rad(yaw)[1], abs=0.003)


def test_on_its_way_the_head_keeps_clear_of_its_shell(opened: Opened) -> None:
    robot = opened()
    robot.head.look(HeadAngles(0.0, 0.515), 5.0)
    run(robot, 1.0)
    robot.head.look(HeadAngles(2.08, 0.33), 3.0)
    for _ in range(100):
        run(robot, 0.01)
        truth = robot._world.snapshot(robot.clock.now_ns()).angles_rad
        assert truth[PITCH] <= pitch_range_rad(truth[YAW])[1] + 0.03


def test_the_head_is_no_faster_than_its_motor(opened: Opened) -> None:
    robot = opened()
    robot.head.look(HeadAngles(2.0, 0.0), 1000.0)
    angles = []
    for _ in range(40):
        run(robot, 0.01)
        angles.append(robot._world.snapshot(robot.clock.now_ns()).angles_rad[YAW])
    fastest = np.diff(angles).max() / 0.01
    assert 0.9 * HEAD_SPEED_MAX_RAD_S[0] < fastest <= HEAD_SPEED_MAX_RAD_S[0] + 1e-6


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_a_head_command_that_is_not_finite_is_refused(opened: Opened, bad: float) -> None:
    robot = opened()
    for target, speed in (
        (HeadAngles(bad, 0.0), 1.0),
        (HeadAngles(0.0, bad), 1.0),
        (HeadAngles(0.1, 0.0), bad),
        (HeadAngles(0.1, 0.0), 0.0),
    ):
        with pytest.raises(MotionRefusedError):
            robot.head.look(target, speed)
    run(robot, 0.5)
    assert robot.body.latest().angles_rad[YAW] == pytest.approx(0.0, abs=0.003)


def test_battery_and_temperature_change_slowly_and_plausibly(opened: Opened) -> None:
    robot = opened()
    first = robot.body.latest()
    run(robot, 60.0)
    last = robot.body.latest()
    assert 0.0 < first.battery - last.battery < 0.05
    assert 30.0 < first.temperature_max_c < last.temperature_max_c < 70.0


def test_truth_has_a_cylinders_face_towards_the_camera(opened: Opened) -> None:
    robot = opened()
    robot.place(PlanarMotion(0.6, 0.5, -0.6))
    truth = robot.truth()
    z = truth.T_world_object[:3, 2]
    out = truth.T_world_camera[:3, 3] - truth.T_world_object[:3, 3]
    assert z[2] == 0.0
    assert z[:2] == pytest.approx(out[:2] / np.hypot(*out[:2]))
    assert np.linalg.det(truth.T_world_object[:3, :3]) == pytest.approx(1.0)
    until_standing(robot)


def test_the_room_is_seen_with_the_robot_in_it(opened: Opened) -> None:
    robot = opened()
    here = robot.room_view(160, 120)
    assert here.shape == (120, 160, 3)
    assert here.dtype == np.uint8
    robot.place(PlanarMotion(0.4, 0.3, 0.0))
    there = robot.room_view(160, 120)
    changed = np.abs(here.astype(int) - there).max(axis=2) > 20
    assert 0.01 < changed.mean() < 0.4
