"""The tick: start from the measured pose, stiffness ramped, modes by button, fall and leaving."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lola_sensed import DT, sensed

from hal.lola.actuators import Actuators
from hal.lola.core import STIFF_LEGS, Core, CoreState, HeadWish, Wanted
from hal.lola.engine import EngineCommand, EngineReport, Motion
from hal.lola.poses import LEGS, SEAT, STAND, is_seated
from hal.lola.sensors import Sensors
from hal.lola.standing import StandingEngine, StandingState
from hal.nao.head_limits import pitch_range_rad
from hal.nao.joints import JOINT_INDEX, LOWER_RAD, UPPER_RAD
from hal.types import HeadAngles, PlanarMotion

CORE = Core(StandingEngine())
NOTHING = Wanted()


@dataclass
class Robot:
    """A robot that does at once what it is told where it is stiff."""

    angles: np.ndarray = field(default_factory=STAND.copy)
    stiffness: np.ndarray = field(default_factory=lambda: np.zeros(26))
    state: CoreState[StandingState] | None = None
    sent: Actuators | None = None
    more: dict = field(default_factory=dict)

    def sensors(self) -> Sensors:
        return sensed(self.angles, stiffness=self.stiffness, **self.more)

    def tick(self, wanted: Wanted = NOTHING, times: int = 1) -> Actuators:
        for _ in range(times):
            sensors = self.sensors()
            dt = DT if self.state is not None else 0.0
            if self.state is None:
                self.state = CORE.begin(sensors)
            self.state, self.sent = CORE.step(self.state, sensors, wanted, dt)
            held = self.sent.stiffness > 0.0
            self.angles = np.where(held, self.sent.angles_rad, self.angles)
            self.stiffness = self.sent.stiffness.copy()
        assert self.sent is not None
        return self.sent

    def press(self, ticks: int = 10) -> None:
        self.more["button"] = True
        self.tick(times=ticks)
        self.more["button"] = False
        self.tick()


@settings(max_examples=20, deadline=None)
@given(st.lists(st.floats(0.0, 1.0), min_size=26, max_size=26), st.floats(0.0, 1.0))
def test_first_targets_are_the_measured_pose_and_nothing_moves_by_itself(
    shares: list[float], stiffness: float
) -> None:
    """S8, whatever the pose and however stiff the program before us has left it."""
    pose = LOWER_RAD + np.array(shares) * (UPPER_RAD - LOWER_RAD)
    low, high = pitch_range_rad(pose[0])
    pose[1] = min(max(pose[1], low), high)
    robot = Robot(pose.copy(), np.full(26, stiffness))
    first = robot.tick()
    assert first.angles_rad == pytest.approx(pose, abs=0.0)
    assert first.stiffness == pytest.approx(np.full(26, stiffness), abs=0.0)
    robot.tick(times=200)
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


@pytest.mark.parametrize("how", [{"roll_pitch": (0.0, 1.2)}, {"accel": (9.81, 0.0, 0.0)}])
def test_robot_that_falls_lets_go_and_stays_so_until_a_press(how: dict) -> None:
    robot = Robot()
    robot.tick(times=80)
    robot.more.update(how)
    robot.tick(times=100)
    assert robot.state is not None
    assert robot.state.balance.fallen
    assert not robot.stiffness.any()
    assert "fallen" in (CORE.refusal(robot.state) or "")
    assert "fallen" in (CORE.head_refusal(robot.state) or "")
    robot.more.clear()
    robot.tick(times=300)
    assert not robot.state.balance.fallen
    assert not robot.stiffness.any(), "upright again, and still nobody has asked for anything"
    robot.press()
    robot.tick(times=80)
    assert robot.stiffness[LEGS].min() == STIFF_LEGS


def test_robot_that_is_lifted_refuses_to_walk() -> None:
    robot = Robot()
    robot.tick(times=80)
    robot.more["load_kg"] = 0.2
    robot.tick(times=50)
    assert robot.state is not None
    assert CORE.refusal(robot.state) == "the feet feel no ground"
    assert robot.stiffness[LEGS].min() == STIFF_LEGS


def test_leaving_sits_down_first_and_is_done_when_limp() -> None:
    robot = Robot()
    robot.tick(times=80)
    robot.tick(Wanted(leave=True))
    assert robot.state is not None
    for _ in range(700):
        if CORE.done(robot.state, robot.sensors()):
            break
        robot.tick()
    assert CORE.done(robot.state, robot.sensors())
    assert is_seated(robot.angles)
    assert robot.sent is not None
    assert not robot.sent.stiffness.any()


def test_leaving_a_pose_from_which_it_cannot_sit_keeps_it_stiff() -> None:
    pose = STAND.copy()
    pose[JOINT_INDEX["LHipRoll"]] = 0.75
    robot = Robot(pose.copy(), np.full(26, 0.6))
    robot.tick(times=50)
    sent = robot.tick(Wanted(leave=True))
    assert robot.state is not None
    assert CORE.done(robot.state, robot.sensors())
    assert sent.stiffness[LEGS].min() > 0.5
    assert sent.angles_rad == pytest.approx(pose)


def test_walk_is_refused_with_the_reason() -> None:
    robot = Robot()
    motion = Motion("velocity", 1, PlanarMotion(0.1, 0.0, 0.0))
    robot.tick(Wanted(motion=motion), times=200)
    assert robot.state is not None
    assert "no walking engine" in (CORE.refusal(robot.state) or "")
    assert robot.angles == pytest.approx(STAND, abs=1e-12)


class Bowing:
    """A walking engine in the place of ours: bows while it is told a velocity, with no care."""

    def begin(self, sensors: Sensors) -> float:
        return 0.0

    def step(
        self, state: float, sensors: Sensors, command: EngineCommand, dt_s: float
    ) -> tuple[float, np.ndarray]:
        angles = STAND.copy()
        if command.motion is not None:
            state += dt_s
            angles[JOINT_INDEX["LKneePitch"]] = 9.0
            angles[JOINT_INDEX["RHipPitch"]] = np.nan
        return state, angles

    def report(self, state: float) -> EngineReport:
        return EngineReport("standing", False, None, odometry=PlanarMotion(state, 0.0, 0.0))


def test_another_engine_plugs_in_and_is_held_to_limits_and_speeds() -> None:
    core = Core(Bowing())
    sensors = sensed(stiffness=0.6)
    state = core.begin(sensors)
    walk = Wanted(motion=Motion("velocity", 1, PlanarMotion(0.1, 0.0, 0.0)))
    knee, hip = JOINT_INDEX["LKneePitch"], JOINT_INDEX["RHipPitch"]
    before = state.guard.angles_rad
    for _ in range(100):
        state, sent = core.step(state, sensors, walk, DT)
        assert np.abs(sent.angles_rad - before)[knee] <= 6.40239 * DT + 1e-12
        before = sent.angles_rad
    assert before[knee] == UPPER_RAD[knee]
    assert before[hip] == STAND[hip]
    assert core.report(state).odometry.x == pytest.approx(100 * DT)
    state, _ = core.step(state, sensors, Wanted(), DT)
    assert core.report(state).odometry.x == pytest.approx(100 * DT), "no wish, no walk"
