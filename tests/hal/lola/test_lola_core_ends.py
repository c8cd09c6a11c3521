"""The tick when things end: a fall, a robot that is left; and when another engine plugs in."""

from __future__ import annotations

import numpy as np
import pytest
from lola_obedient import CORE, NOTHING, Robot
from lola_sensed import DT, sensed

from hal.lola.core import STIFF_LEGS, Core, Wanted
from hal.lola.engine import EngineCommand, EngineReport, Motion
from hal.lola.poses import LEGS, STAND, is_seated
from hal.lola.sensors import Sensors
from hal.lola.standing import StandingEngine
from hal.nao.joints import JOINT_INDEX, UPPER_RAD
from hal.types import PlanarMotion


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


def test_robot_that_falls_may_stay_stiff_and_is_let_go_when_it_is_left() -> None:
    core = Core(StandingEngine(), limp_when_fallen=False)
    sensors = sensed(stiffness=0.6, roll_pitch=(1.2, 0.0))
    state = core.begin(sensors)
    for _ in range(100):
        state, sent = core.step(state, sensors, NOTHING, DT)
    assert state.mode == "fallen"
    assert sent.stiffness[LEGS].min() == STIFF_LEGS
    assert sent.angles_rad == pytest.approx(STAND)
    assert "fallen" in (core.refusal(state) or "")
    for _ in range(100):
        state, sent = core.step(state, sensors, Wanted(leave=True), DT)
    assert core.done(state, sensors)
    assert not sent.stiffness.any()


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
