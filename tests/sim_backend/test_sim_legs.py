"""Leg kinematics there and back, against the chain of joints."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hal.nao.feet import SOLE_IN_ANKLE_M
from hal.nao.joints import JOINT_NAMES, LOWER_RAD, UPPER_RAD
from hal.nao.postures import posture
from sim_backend.figures import links_in_torso, standing_torso
from sim_backend.legs import FIRST_LEFT, FIRST_RIGHT, leg_angles, solve_legs
from sim_backend.poses import Matrix, moved, rot_x, rot_y, rot_z, transform

LEGS = [(1.0, FIRST_LEFT, "l_ankle"), (-1.0, FIRST_RIGHT, "r_ankle")]


def sole_in_torso(angles: np.ndarray, ankle: str) -> Matrix:
    return links_in_torso(angles)[ankle] @ moved(*SOLE_IN_ANKLE_M)


@pytest.mark.parametrize(("side", "first", "ankle"), LEGS)
def test_angles_of_one_leg_come_back(side: float, first: int, ankle: str) -> None:
    rng = np.random.default_rng(5)
    out = np.empty(6)
    leg = slice(first, first + 6)
    for _ in range(300):
        angles = posture("StandInit")
        angles[leg] += rng.uniform(-0.3, 0.3, 6)
        angles = np.clip(angles, LOWER_RAD, UPPER_RAD)
        T = sole_in_torso(angles, ankle)
        assert leg_angles(np.ascontiguousarray(T[:3, :3]), T[:3, 3].copy(), side, out)
        assert out == pytest.approx(angles[leg], abs=1e-9)


def test_a_foot_out_of_reach_is_said_to_be() -> None:
    out = np.empty(6)
    assert not leg_angles(np.eye(3), np.array([0.0, 0.05, -0.5]), 1.0, out)
    assert np.isfinite(out).all()


def test_both_soles_lie_where_asked_with_one_hip_motor() -> None:
    rng = np.random.default_rng(6)
    for _ in range(60):
        lean = rot_x(rng.uniform(-0.03, 0.03)) @ rot_y(rng.uniform(-0.02, 0.02))
        T_torso = standing_torso()
        T_torso[:3, :3] = lean @ T_torso[:3, :3]
        T_torso[:2, 3] += rng.uniform(-0.02, 0.02, 2)
        left = np.array([rng.uniform(-0.02, 0.02), 0.05, 0.0, rng.uniform(0.0, 0.17)])
        right = np.array([rng.uniform(-0.02, 0.02), -0.05, 0.0, rng.uniform(-0.17, 0.0)])
        legs, yaw, reached = solve_legs(T_torso, left, right)
        assert reached
        assert legs[0] == pytest.approx(legs[6], abs=1e-10)
        turned = T_torso.copy()
        turned[:3, :3] = rot_z(yaw) @ T_torso[:3, :3]
        angles = posture("StandInit")
        angles[FIRST_LEFT : FIRST_LEFT + 6], angles[FIRST_RIGHT : FIRST_RIGHT + 6] = np.split(
            legs, 2
        )
        for sole, ankle in ((left, "l_ankle"), (right, "r_ankle")):
            wanted = transform(rot_z(sole[3]), tuple(sole[:3]))
            assert turned @ sole_in_torso(angles, ankle) == pytest.approx(wanted, abs=1e-8)


def test_standing_feet_give_the_standing_posture() -> None:
    legs, yaw, _ = solve_legs(
        standing_torso(), np.array([0.0, 0.05, 0.0, 0.0]), np.array([0.0, -0.05, 0.0, 0.0])
    )
    names = [name for name in JOINT_NAMES if name.startswith(("LHip", "LKnee", "LAnkle"))]
    assert legs[:6] == pytest.approx([posture("StandInit")[JOINT_NAMES.index(n)] for n in names])
    assert yaw == pytest.approx(0.0, abs=1e-12)
    assert math.isclose(legs[3], 0.7, abs_tol=1e-9)
