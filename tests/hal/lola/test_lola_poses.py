"""Standing up and sitting down must keep the mass over the feet and the feet on the floor."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from hal.lola.poses import LEGS, SEAT, STAND, is_on_the_way, is_seated
from hal.nao.feet import LEFT_SOLE_OUTLINE_M, SOLE_IN_ANKLE_M
from hal.nao.joints import JOINT_INDEX, JOINT_NAMES, LOWER_RAD, UPPER_RAD
from hal.nao.postures import posture
from sim_backend.urdf import urdf_text


@pytest.fixture(scope="module")
def model() -> tuple[pin.Model, pin.Data]:
    built = pin.buildModelFromXML(urdf_text("v6"))
    return built, built.createData()


@pytest.mark.parametrize("share", np.linspace(0.0, 1.0, 9))
def test_mass_stays_over_the_flat_soles_all_the_way(
    model: tuple[pin.Model, pin.Data], share: float
) -> None:
    """By pinocchio on the simulation's URDF, which the poses know nothing of."""
    built, data = model
    angles = STAND + share * (SEAT - STAND)
    q = pin.neutral(built)
    for name, angle in zip(JOINT_NAMES, angles, strict=True):
        if not name.endswith("Hand"):
            q[built.joints[built.getJointId(name)].idx_q] = angle
    com = pin.centerOfMass(built, data, q)
    pin.forwardKinematics(built, data, q)
    left, right = (data.oMi[built.getJointId(f"{side}AnkleRoll")] for side in "LR")
    assert left.rotation == pytest.approx(right.rotation, abs=1e-9)
    apart = left.actInv(right).translation
    assert apart == pytest.approx([0.0, -0.1, 0.0], abs=1e-9)
    x, y, height = left.actInv(com) - np.array(SOLE_IN_ANKLE_M)
    front = max(px for px, _ in LEFT_SOLE_OUTLINE_M)
    back = min(px for px, _ in LEFT_SOLE_OUTLINE_M)
    assert back + 0.04 < x < front - 0.04
    assert y == pytest.approx(-0.05, abs=0.003)
    assert height > 0.15


def test_poses_are_within_the_joints_ranges() -> None:
    for pose in (STAND, SEAT):
        assert (pose >= LOWER_RAD).all()
        assert (pose <= UPPER_RAD).all()


def test_who_is_seated_and_who_can_go_there() -> None:
    assert is_seated(SEAT)
    assert not is_seated(STAND)
    for share in np.linspace(0.0, 1.0, 5):
        assert is_on_the_way(STAND + share * (SEAT - STAND))
    assert is_on_the_way(posture("StandZero") * 0.5 + STAND * 0.5)
    spread = STAND.copy()
    spread[JOINT_INDEX["LHipRoll"]] = 0.7
    assert not is_on_the_way(spread)
    wild = STAND.copy()
    wild[[i for i in range(26) if i not in LEGS]] = 0.0
    assert is_on_the_way(wild), "arms and head do not matter"
