"""The tick: start from the measured pose, stiffness ramped, the head, the chest button."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lola_obedient import Robot
from lola_sensed import DT

from hal.lola.core import STIFF_LEGS, HeadWish, Wanted
from hal.lola.poses import LEGS, SEAT, STAND, is_seated
from hal.nao.ankle_limits import left_roll_range_rad, right_roll_range_rad
from hal.nao.head_limits import pitch_range_rad
from hal.nao.joints import JOINT_INDEX, LOWER_RAD, UPPER_RAD
from hal.types import HeadAngles

COUPLED = (
    ("HeadYaw", "HeadPitch", pitch_range_rad),
    ("LAnklePitch", "LAnkleRoll", left_roll_range_rad),
    ("RAnklePitch", "RAnkleRoll", right_roll_range_rad),
)


@settings(max_examples=20, deadline=None)
@given(st.lists(st.floats(0.0, 1.0), min_size=26, max_size=26), st.floats(0.0, 1.0))
def test_first_targets_are_the_measured_pose_and_nothing_moves_by_itself(
    shares: list[float], stiffness: float
) -> None:
    """S8, whatever the pose and however stiff the program before us has left it."""
    pose = LOWER_RAD + np.array(shares) * (UPPER_RAD - LOWER_RAD)
    for leads, follows, range_rad in COUPLED:
        low, high = range_rad(pose[JOINT_INDEX[leads]])
        pose[JOINT_INDEX[follows]] = min(max(pose[JOINT_INDEX[follows]], low), high)
    robot = Robot(pose.copy(), np.full(26, stiffness))
    first = robot.tick()
    assert first.angles_rad == pytest.approx(pose, abs=0.0)
    assert first.stiffness == pytest.approx(np.full(26, stiffness), abs=0.0)
    robot.tick(times=60)
    assert robot.sent is not None
    assert robot.sent.angles_rad == pytest.approx(pose, abs=1e-12)


def test_stiffness_is_ramped_from_what_it_is() -> None:
    robot = Robot()
    knee = JOINT_INDEX["LKneePitch"]
    levels = [robot.tick().stiffness[knee] for _ in range(100)]
    rises = np.diff(levels)
    assert levels[0] == 0.0
    assert (rises >= 0.0).all()
    assert rises.max() <= 1.0 * DT + 1e-12
    assert levels[-1] == STIFF_LEGS
    assert levels.index(STIFF_LEGS) == pytest.approx(STIFF_LEGS / DT, abs=1.5)


def test_joint_that_is_not_stiff_is_told_where_it_is() -> None:
    """A limb that somebody moves while it is free must not snap back when it is stiffened."""
    robot = Robot()
    robot.more["roll_pitch"] = (0.0, 1.4)
    robot.tick(times=100)
    assert robot.state is not None
    assert robot.state.mode == "fallen"
    robot.angles = robot.angles + 0.3
    sent = robot.tick()
    assert not sent.stiffness.any()
    assert sent.angles_rad == pytest.approx(robot.angles, abs=0.0)


def test_head_turns_at_its_speed_and_within_its_range() -> None:
    robot = Robot()
    robot.tick(times=80)
    wanted = Wanted(head=HeadWish(HeadAngles(2.0, 0.5), 1.2))
    before = robot.angles[:2].copy()
    for _ in range(200):
        robot.tick(wanted)
        assert np.abs(robot.angles[:2] - before).max() <= 1.2 * DT + 1e-12
        low, high = pitch_range_rad(robot.angles[0])
        assert low - 1e-12 <= robot.angles[1] <= high + 1e-12
        before = robot.angles[:2].copy()
    assert robot.angles[0] == pytest.approx(2.0)
    assert robot.angles[1] == pytest.approx(pitch_range_rad(2.0)[1])


def test_head_stays_where_it_is_when_nobody_wants_anything_any_more() -> None:
    robot = Robot()
    robot.tick(times=80)
    robot.tick(Wanted(head=HeadWish(HeadAngles(1.0, 0.0), 0.5)), times=40)
    stopped = robot.angles[0]
    assert 0.1 < stopped < 0.5
    robot.tick(times=40)
    assert robot.angles[0] == stopped


def test_short_press_sits_it_down_and_lets_go_and_another_stands_it_up() -> None:
    robot = Robot()
    robot.tick(times=80)
    robot.press()
    soft_at = None
    for _ in range(600):
        sent = robot.tick()
        if soft_at is None and sent.stiffness[LEGS].min() < STIFF_LEGS:
            soft_at = robot.angles.copy()
    assert soft_at is not None
    assert is_seated(soft_at), "stiffness goes down when it sits, not before"
    assert not robot.stiffness.any()
    robot.press()
    robot.tick(times=600)
    assert robot.angles[LEGS] == pytest.approx(STAND[LEGS], abs=1e-9)
    assert robot.stiffness[LEGS].min() == STIFF_LEGS


def test_way_from_seat_to_stand_is_slow() -> None:
    robot = Robot(SEAT.copy())
    robot.tick(times=80)
    robot.press()
    before = robot.angles.copy()
    for _ in range(500):
        robot.tick()
        assert np.abs(robot.angles - before).max() <= 0.6 * DT * 1.001
        before = robot.angles.copy()
    assert robot.angles[LEGS] == pytest.approx(STAND[LEGS], abs=1e-9)


def test_long_press_counts_before_it_is_let_go() -> None:
    robot = Robot(SEAT.copy())
    robot.tick(times=80)
    robot.more["button"] = True
    robot.tick(times=round(3.2 / DT))
    assert robot.state is not None
    assert robot.state.mode == "rest"
    robot.more["button"] = False
    robot.tick()
    assert robot.state.mode == "rest", "and its end is no second press"


def test_button_that_is_down_when_we_come_does_not_count() -> None:
    robot = Robot(more={"button": True})
    robot.tick(times=400)
    robot.more["button"] = False
    robot.tick(times=3)
    assert robot.state is not None
    assert robot.state.mode == "hold"


def test_standing_up_waits_for_joints_that_do_not_follow() -> None:
    """Somebody holds the knees: targets must not run away from them."""
    robot = Robot(SEAT.copy())
    robot.tick(times=80)
    robot.press()
    for _ in range(300):
        robot.tick()
        robot.angles = SEAT.copy()
    assert robot.sent is not None
    assert np.abs(robot.sent.angles_rad - SEAT)[LEGS].max() < 0.35
