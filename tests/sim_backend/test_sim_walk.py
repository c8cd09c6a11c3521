"""How the kinematic walk moves the robot, in lock-step."""

from __future__ import annotations

import math

import numpy as np
import pytest
from sim_world import TICK_S, Opened, base, run, until_standing

from hal.nao.feet import SOLE_IN_ANKLE_M
from hal.nao.joints import LOWER_RAD, UPPER_RAD
from hal.scenario import Scenario, WalkSection
from hal.types import PlanarMotion
from sim_backend.body import Body
from sim_backend.poses import between, moved, wrapped
from sim_backend.steps import STEP_PERIOD_S, VELOCITY_MAX

MOVES = [
    (0.3, 0.0, 0.0),
    (-0.15, 0.0, 0.0),
    (0.0, 0.12, 0.0),
    (0.0, -0.12, 0.0),
    (0.0, 0.0, 1.5),
    (0.0, 0.0, -2.5),
    (0.25, 0.1, 0.5),
    (0.004, -0.003, 0.01),
]


@pytest.mark.parametrize("move", MOVES)
def test_without_slip_a_move_ends_where_it_was_sent(
    opened: Opened, move: tuple[float, float, float]
) -> None:
    robot = opened()
    robot.place(PlanarMotion(0.1, -0.2, 0.4))
    begin = base(robot)
    assert robot.walk.move_to(PlanarMotion(*move), 60.0) == PlanarMotion(*move)
    until_standing(robot)
    x, y, yaw = between(begin, base(robot))
    assert (x, y) == pytest.approx(move[:2], abs=1e-3)
    assert wrapped(yaw - move[2]) == pytest.approx(0.0, abs=1e-3)
    odometry = robot.walk.status().odometry
    assert (odometry.x, odometry.y) == pytest.approx(move[:2], abs=1e-3)


def test_a_move_of_nothing_moves_nothing(opened: Opened) -> None:
    robot = opened()
    robot.walk.move_to(PlanarMotion(0.0, 0.0, 0.0), 5.0)
    assert not robot.walk.status().moving


def test_steps_keep_to_the_limits_and_soles_lie_flat_in_double_support(opened: Opened) -> None:
    robot = opened()
    robot.walk.move_to(PlanarMotion(0.2, 0.08, 0.6), 60.0)
    body, both, single = Body("v6"), 0, 0
    while robot.walk.status().moving:
        run(robot, TICK_S)
        state = robot._world.present(robot.clock.now_ns())
        frames = body.link_frames(state.T_world_torso, state.angles_rad)
        soles = [frames[ankle] @ moved(*SOLE_IN_ANKLE_M) for ankle in ("l_ankle", "r_ankle")]
        for T in soles:
            assert T[:3, 2] == pytest.approx((0.0, 0.0, 1.0), abs=1e-5)
            assert -1e-5 < T[2, 3] < 0.021
        lifted = max(float(T[2, 3]) for T in soles)
        both, single = both + (lifted < 1e-5), single + (lifted > 0.015)
        load = sum(robot.body.latest().foot_load_kg)
        assert load == pytest.approx(5.36, abs=0.15)
        assert (state.angles_rad <= UPPER_RAD + 1e-9).all()
        assert (state.angles_rad >= LOWER_RAD - 1e-9).all()
        apart = between_soles(soles)
        assert math.hypot(apart[0], apart[1] - 0.1) < 0.06
    body.close()
    assert both > 50
    assert single > 50
    assert apart == pytest.approx((0.0, 0.1, 0.0), abs=1e-6)


def between_soles(soles: list[np.ndarray]) -> tuple[float, float, float]:
    """Left foot in the frame of the right."""
    left, right = (
        (float(T[0, 3]), float(T[1, 3]), math.atan2(float(T[1, 0]), float(T[0, 0]))) for T in soles
    )
    return between(right, left)


def test_the_weight_goes_from_foot_to_foot(opened: Opened) -> None:
    robot = opened()
    robot.walk.set_velocity(PlanarMotion(0.08, 0.0, 0.0), 20.0)
    shares = []
    for _ in range(400):
        run(robot, TICK_S)
        left, right = robot.body.latest().foot_load_kg
        shares.append(left / (left + right))
    assert min(shares) < 0.02
    assert max(shares) > 0.98
    assert np.mean(shares[100:]) == pytest.approx(0.5, abs=0.05)


@pytest.mark.parametrize(
    "asked", [(0.09, 0.0, 0.0), (-0.06, 0.0, 0.0), (0.0, 0.05, 0.0), (0.0, 0.0, -0.5)]
)
def test_a_velocity_is_walked_at(opened: Opened, asked: tuple[float, float, float]) -> None:
    robot = opened()
    assert robot.walk.set_velocity(PlanarMotion(*asked), 60.0) == PlanarMotion(*asked)
    run(robot, 2.0 * STEP_PERIOD_S + 0.8)
    begin, cycles = base(robot), 6
    run(robot, cycles * 2.0 * STEP_PERIOD_S)
    way = between(begin, base(robot))
    seconds = cycles * 2.0 * STEP_PERIOD_S
    assert way == pytest.approx([rate * seconds for rate in asked], abs=0.012)


def test_too_fast_is_clipped_and_said_so(opened: Opened) -> None:
    robot = opened()
    sent = robot.walk.set_velocity(PlanarMotion(5.0, 0.0, 0.0), 5.0)
    assert sent == PlanarMotion(VELOCITY_MAX.x, 0.0, 0.0)
    sent = robot.walk.set_velocity(PlanarMotion(5.0, -5.0, 5.0), 5.0)
    shares = (sent.x / VELOCITY_MAX.x, sent.y / VELOCITY_MAX.y, sent.yaw / VELOCITY_MAX.yaw)
    assert math.hypot(*shares) == pytest.approx(1.0)
    assert robot.walk.status().velocity == sent
    assert robot.walk.move_to(PlanarMotion(0.0, 0.0, 9.0), 5.0).yaw == math.pi


def test_the_body_sways_and_the_camera_with_it(opened: Opened) -> None:
    robot = opened()
    robot.walk.set_velocity(PlanarMotion(0.08, 0.0, 0.0), 60.0)
    run(robot, 2.0)
    places, ups = [], []
    for _ in range(168):
        run(robot, TICK_S)
        T = robot.truth().T_world_camera
        places.append(T[1, 3])
        ups.append(math.atan2(T[2, 0], -T[2, 1]))
    assert np.ptp(places) / 2.0 == pytest.approx(0.024, abs=0.008)
    assert 0.5 < math.degrees(np.ptp(ups) / 2.0) < 1.7


def test_slip_differs_from_move_to_move_and_odometry_knows_nothing(opened: Opened) -> None:
    robot = opened(Scenario(walk=WalkSection(slip_std=0.1, yaw_drift=0.0)))
    ratios = []
    for _ in range(6):
        begin, believed = base(robot), robot.walk.status().odometry
        robot.walk.move_to(PlanarMotion(0.2, 0.0, 0.0), 60.0)
        until_standing(robot)
        assert robot.walk.status().odometry.x - believed.x == pytest.approx(0.2, abs=1e-6)
        ratios.append(between(begin, base(robot))[0] / 0.2)
    assert len({round(ratio, 6) for ratio in ratios}) == 6
    assert 0.02 < np.std(ratios) < 0.25


def test_drift_turns_the_robot_by_the_metre(opened: Opened) -> None:
    robot = opened(Scenario(walk=WalkSection(slip_std=0.0, yaw_drift=0.1)))
    robot.walk.move_to(PlanarMotion(0.5, 0.0, 0.0), 60.0)
    until_standing(robot)
    assert base(robot)[2] == pytest.approx(0.05, abs=2e-3)
    assert robot.walk.status().odometry.yaw == pytest.approx(0.0, abs=1e-9)
