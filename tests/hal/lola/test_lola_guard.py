"""Whatever an engine wants: ranges, coupled ranges, speeds and ramps hold at every tick."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from lola_sensed import DT, sensed

from hal.lola import guard
from hal.lola.poses import SEAT, STAND
from hal.nao.ankle_limits import left_roll_range_rad, right_roll_range_rad
from hal.nao.head_limits import pitch_range_rad
from hal.nao.joints import JOINT_INDEX, JOINTS, LOWER_RAD, UPPER_RAD

FACTS = Path(__file__).parents[3] / ".." / "shared" / "nao" / "nao_kinematics.yaml"


def at(angles: np.ndarray, name: str) -> float:
    return float(angles[JOINT_INDEX[name]])


def assert_coupled(sent: np.ndarray) -> None:
    for value, (low, high) in (
        (at(sent, "HeadPitch"), pitch_range_rad(at(sent, "HeadYaw"))),
        (at(sent, "LAnkleRoll"), left_roll_range_rad(at(sent, "LAnklePitch"))),
        (at(sent, "RAnkleRoll"), right_roll_range_rad(at(sent, "RAnklePitch"))),
    ):
        assert low - 1e-6 <= value <= high + 1e-6


@pytest.mark.parametrize("start", [STAND, SEAT], ids=["stand", "seat"])
@pytest.mark.parametrize("seed", range(4))
def test_ranges_and_speeds_hold_at_every_tick(seed: int, start: np.ndarray) -> None:
    rng = np.random.default_rng(seed)
    sensors = sensed(start, stiffness=0.6)
    state = guard.begin(sensors)
    speeds = np.array([joint.speed_max_rad_s for joint in JOINTS])
    for _ in range(12):
        wish = rng.uniform(-3.0, 3.0, 26)
        odd = rng.random(26) < 0.2
        wish[odd] = rng.choice([np.nan, np.inf, -np.inf, 1e300], odd.sum())
        for _ in range(25):
            after = guard.step(state, sensors, wish, np.abs(wish), DT)
            moved = np.abs(after.angles_rad - state.angles_rad)
            assert (moved <= speeds * DT + 1e-12).all()
            assert (np.abs(after.stiffness - state.stiffness) <= 1.0 * DT + 1e-12).all()
            assert (after.stiffness > 0.0).all()
            assert (after.stiffness <= 1.0).all()
            assert (after.angles_rad >= LOWER_RAD - 1e-9).all()
            assert (after.angles_rad <= UPPER_RAD + 1e-9).all()
            assert_coupled(after.angles_rad)
            state = after


def test_coupled_ranges_are_come_to_exactly() -> None:
    sensors = sensed(stiffness=0.6)
    state = guard.begin(sensors)
    wish = STAND.copy()
    for side, roll in (("L", 0.7), ("R", -0.7)):
        wish[JOINT_INDEX[f"{side}AnklePitch"]] = -0.840027
        wish[JOINT_INDEX[f"{side}AnkleRoll"]] = roll
    for _ in range(100):
        state = guard.step(state, sensors, wish, np.full(26, 0.6), DT)
    assert at(state.angles_rad, "LAnkleRoll") == pytest.approx(0.169995)
    assert at(state.angles_rad, "RAnkleRoll") == pytest.approx(-0.169995)


def test_pose_found_outside_the_ranges_is_left_slowly() -> None:
    """A knee pressed on its stop by somebody: no jump, and then into the range."""
    pose = STAND.copy()
    knee = JOINT_INDEX["LKneePitch"]
    pose[knee] = UPPER_RAD[knee] + 0.1
    sensors = sensed(pose, stiffness=0.6)
    state = guard.begin(sensors)
    state = guard.step(state, sensors, pose, np.full(26, 0.6), 0.0)
    assert state.angles_rad[knee] == pose[knee]
    state = guard.step(state, sensors, pose, np.full(26, 0.6), DT)
    assert pose[knee] - 6.41 * DT <= state.angles_rad[knee] < pose[knee]
    for _ in range(10):
        state = guard.step(state, sensors, pose, np.full(26, 0.6), DT)
    assert state.angles_rad[knee] == UPPER_RAD[knee]


@pytest.mark.parametrize("side", ["left", "right"])
def test_ankle_ranges_are_the_published_ones(side: str) -> None:
    if not FACTS.exists():
        pytest.skip("the published facts are not beside this repository")
    part = FACTS.read_text().split("ankle_roll_limits_by_ankle_pitch:")[1]
    rows = re.findall(r"- \[([-\d.]+), ([-\d.]+), ([-\d.]+)\]", part.split(f"{side}:")[1])[:7]
    assert len(rows) == 7
    found = left_roll_range_rad if side == "left" else right_roll_range_rad
    for pitch, low, high in rows:
        assert found(float(pitch)) == pytest.approx((float(low), float(high)), abs=1e-6)
