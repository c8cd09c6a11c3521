"""The body that 25 joint targets drive: where they put it, and when it falls."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from hal.lola.poses import LEGS, SEAT, STAND
from hal.nao.feet import SOLE_IN_ANKLE_M
from hal.nao.joints import JOINT_INDEX, JOINT_NAMES, LOWER_RAD, UPPER_RAD
from hal.scenario import Scenario
from sim_backend.defaults import resolved
from sim_backend.figures import standing_torso
from sim_backend.speak.lola_body import JointWorld, Servos, torso_over_soles
from sim_backend.urdf import urdf_text

STIFF = np.full(26, 0.6)
MS = 1_000_000


@pytest.fixture
def world() -> JointWorld:
    return JointWorld(resolved(Scenario()), "v6", 0, None, STAND)


def run(world: JointWorld, seconds: float) -> None:
    world.run_to(world.start_ns + round(seconds * 1e9))


def test_it_stands_at_first_as_the_simulation_does(world: JointWorld) -> None:
    found = world.snapshot(0)
    assert found is not None
    assert found.angles_rad == pytest.approx(STAND)
    assert found.T_world_torso == pytest.approx(standing_torso(), abs=1e-9)
    assert found.loads == pytest.approx((0.5, 0.5))


@pytest.mark.parametrize("share", [0.0, 0.4, 1.0])
def test_soles_are_on_the_floor_by_other_kinematics(share: float) -> None:
    angles = STAND + share * (SEAT - STAND)
    angles[[JOINT_INDEX["LHipYawPitch"], JOINT_INDEX["RHipYawPitch"]]] = -0.2
    T_base_torso, _ = torso_over_soles(angles)
    model = pin.buildModelFromXML(urdf_text("v6"))
    data, q = model.createData(), pin.neutral(model)
    for name, angle in zip(JOINT_NAMES, angles, strict=True):
        if not name.endswith("Hand"):
            q[model.joints[model.getJointId(name)].idx_q] = angle
    pin.forwardKinematics(model, data, q)
    heights = []
    for side in "LR":
        ankle = data.oMi[model.getJointId(f"{side}AnkleRoll")]
        heights.append((T_base_torso @ (*ankle.act(np.array(SOLE_IN_ANKLE_M)), 1.0))[:3])
    assert min(heights[0][2], heights[1][2]) == pytest.approx(0.0, abs=1e-9)
    assert 0.5 * (heights[0] + heights[1])[:2] == pytest.approx([0.0, 0.0], abs=1e-9)


def test_stiff_joints_come_to_their_targets_at_their_speed() -> None:
    servos = Servos(STAND)
    target = STAND.copy()
    target[:2] = (1.5, 0.1)
    servos.drive(target, STIFF)
    before = servos.angles_rad.copy()
    for _ in range(100):
        servos.run(0.01)
        assert abs(servos.angles_rad[0] - before[0]) <= 7.46 * 0.01 + 1e-12
        before = servos.angles_rad.copy()
    assert servos.angles_rad == pytest.approx(target, abs=1e-6)


def test_free_joint_stays_and_ranges_hold() -> None:
    servos = Servos(STAND)
    stiffness = STIFF.copy()
    stiffness[0] = -1.0
    servos.drive(np.full(26, 9.0), stiffness)
    for _ in range(300):
        servos.run(0.01)
    assert servos.angles_rad[0] == STAND[0]
    assert servos.angles_rad[1:] == pytest.approx(UPPER_RAD[1:], abs=1e-6)
    assert (servos.angles_rad >= LOWER_RAD).all()


def test_standing_robot_that_was_held_by_its_motors_falls_without_them(world: JointWorld) -> None:
    run(world, 0.2)
    assert world.summary() == "stands, its joints free", "somebody holds it at first"
    world.drive(STAND, STIFF)
    run(world, 0.4)
    assert world.summary() == "stands, its joints stiff"
    world.drive(None, np.zeros(26))
    run(world, 2.0)
    assert world.summary() == "has fallen"
    found = world.measured(1900 * MS, 2000 * MS)
    assert found is not None
    assert abs(found.torso_roll_pitch_rad[1]) > 1.2
    assert sum(found.foot_load_kg) < 0.2


def test_seated_robot_may_lose_its_stiffness(world: JointWorld) -> None:
    world.drive(SEAT, STIFF)
    run(world, 3.0)
    found = world.snapshot(2900 * MS)
    assert found is not None
    assert found.angles_rad[LEGS] == pytest.approx(SEAT[LEGS], abs=1e-3)
    assert found.T_world_torso[2, 3] == pytest.approx(0.229, abs=0.002)
    world.drive(None, np.full(26, -1.0))
    run(world, 4.0)
    assert world.summary() == "sits, its joints free"


def test_lifting_one_foot_takes_its_load() -> None:
    angles = STAND.copy()
    angles[JOINT_INDEX["LKneePitch"]] += 0.3
    _, (left, right) = torso_over_soles(angles)
    assert (left, right) == (0.0, 1.0)
