"""What a scenario leaves open is filled in; what cannot be is refused in one line."""

from __future__ import annotations

import math
from pathlib import Path

import cv2
import numpy as np
import pytest
from sim_world import Opened

from hal.backends import OpenOptions, open_robot
from hal.errors import BackendError, HalError, ScenarioError
from hal.nao.links import links
from hal.scenario import (
    CameraSection,
    GoalSection,
    RobotSection,
    Scenario,
    SceneSection,
    ThingSection,
    WalkSection,
)
from sim_backend.clutter import clutter
from sim_backend.defaults import resolved
from sim_backend.furniture import has_table, table_frame
from sim_backend.room import furnished

BAD = [
    (Scenario(object=ThingSection(width_m=0.1)), r"object\.width_m"),
    (Scenario(object=ThingSection(kind="rectangle", radius_m=0.1)), r"object\.radius_m"),
    (Scenario(distractor=(ThingSection(width_m=1.0),)), r"distractor\[0\]\.width_m"),
    (Scenario(object=ThingSection(position=(1.0, 0.0, -0.2))), r"object\.position"),
    (Scenario(object=ThingSection(position=(math.nan, 0.0, 0.2))), r"object\.position"),
    (Scenario(object=ThingSection(position=(1e9, 0.0, 0.2))), r"object\.position"),
    (Scenario(object=ThingSection(yaw_deg=math.inf)), r"object\.yaw_deg"),
    (Scenario(robot=RobotSection(start=(math.nan, 0.0, 0.0))), r"robot\.start"),
    (Scenario(goal=GoalSection(demonstrate_at=(0.0, math.inf, 0.0))), r"goal\.demonstrate_at"),
    (Scenario(walk=WalkSection(model="dynamic")), r"walk\.model"),
    (Scenario(walk=WalkSection(yaw_drift=math.nan)), r"walk\.yaw_drift"),
    (Scenario(camera=CameraSection(latency_s=60.0)), r"camera\.latency_s"),
    (
        Scenario(camera=CameraSection(mount_error_deg=(0.0, math.nan, 0.0))),
        r"camera\.mount_error_deg",
    ),
    (Scenario(camera=CameraSection(noise_std=math.inf)), r"camera\.noise_std"),
    (Scenario(object=ThingSection(texture="none.png")), r"object\.texture"),
    (Scenario(distractor=(ThingSection(texture="none.png"),)), r"distractor\[0\]\.texture"),
    (Scenario(scene=SceneSection(background="none.png")), r"scene\.background"),
]


@pytest.mark.parametrize(("scenario", "key"), BAD)
def test_what_cannot_be_is_refused_by_key(scenario: Scenario, key: str) -> None:
    with pytest.raises(ScenarioError, match=rf"^{key}: ") as caught:
        open_robot("sim", OpenOptions(section={"scenario": scenario}))
    assert "\n" not in str(caught.value)


def test_an_unreadable_picture_is_refused(tmp_path: Path) -> None:
    (tmp_path / "broken.png").write_bytes(b"no picture")
    scenario = Scenario(object=ThingSection(texture="broken.png"))
    section = {"scenario": scenario, "scenario_folder": tmp_path}
    with pytest.raises(ScenarioError, match=r"^object\.texture: not a readable picture"):
        open_robot("sim", OpenOptions(section=section))


WRONG = [
    {"scenario": "file.toml"},
    {"seed": -1},
    {"seed": 1.5},
    {"seed": True},
    {"real_time": 1},
    {"scenario_folder": "here"},
    {"speed": 2},
]


@pytest.mark.parametrize("section", WRONG)
def test_wrong_options_are_refused_by_name(section: dict[str, object]) -> None:
    with pytest.raises(BackendError, match=next(iter(section))):
        open_robot("sim", OpenOptions(section=section))


@pytest.mark.parametrize("figures", [{"width": 641}, {"fps": 0}, {"fps": 31}])
def test_impossible_cameras_are_refused(figures: dict[str, int]) -> None:
    with pytest.raises(HalError):
        open_robot("sim", OpenOptions(**figures))


@pytest.mark.parametrize("kind", ["cylinder", "rectangle"])
def test_nothing_that_applies_is_left_open(kind: str) -> None:
    filled = resolved(Scenario(object=ThingSection(kind=kind), distractor=(ThingSection(),) * 3))
    for thing in (filled.object, *filled.distractor):
        given = {thing.position, thing.colour, thing.height_m}
        assert None not in given
        assert (thing.radius_m is None) == (thing.kind == "rectangle")
        assert (thing.width_m is None) == (thing.kind == "cylinder")
    assert resolved(filled) == filled


def test_the_goal_stands_before_the_object_and_looks_at_it() -> None:
    for yaw_deg in (180.0, 90.0, -30.0):
        thing = ThingSection(position=(1.0, 0.5, 0.3), yaw_deg=yaw_deg)
        x, y, facing = resolved(Scenario(object=thing)).goal.demonstrate_at
        assert math.hypot(x - 1.0, y - 0.5) == pytest.approx(0.45)
        assert math.atan2(0.5 - y, 1.0 - x) == pytest.approx(math.radians(facing), abs=1e-6)


def test_the_can_stands_on_its_table() -> None:
    scenario = resolved(Scenario())
    assert has_table(scenario)
    top = table_frame(scenario)[2, 3]
    assert top == pytest.approx(scenario.object.position[2] - scenario.object.height_m / 2.0)
    on_floor = ThingSection(height_m=0.115, position=(1.0, 0.0, 0.0575))
    assert not has_table(resolved(Scenario(object=on_floor)))
    bare = resolved(Scenario(scene=SceneSection(table=False)))
    assert not has_table(bare)


def test_clutter_depends_on_the_seed_and_keeps_off_the_object() -> None:
    scenario = resolved(Scenario(scene=SceneSection(background="clutter")))
    own = np.array(scenario.object.colour, dtype=float)
    rooms = [furnished(scenario, Path(), seed) for seed in (0, 0, 1)]
    colours = [[part.colour for part in room] for room in rooms]
    assert colours[0] == colours[1]
    assert colours[0] != colours[2]
    for part in rooms[0]:
        if part.role != "object":
            assert np.linalg.norm(np.array(part.colour) - own) > 40.0


@pytest.mark.parametrize("kind", ["cylinder", "rectangle"])
def test_clutter_leaves_the_way_free(kind: str) -> None:
    scenario = resolved(Scenario(object=ThingSection(kind=kind)))
    start = np.array(scenario.robot.start[:2])
    way = np.array(scenario.object.position[:2]) - start
    for seed in range(20):
        pieces = [part for part in clutter(scenario, seed) if part.kind != "rectangle"]
        assert len(pieces) > 8
        for part in pieces:
            if part.size[1] > 1.0:
                continue  # the screen behind the table
            off = part.T_world[:2, 3] - start
            along = np.clip(off @ way / (way @ way), 0.0, 1.0)
            assert np.linalg.norm(off - along * way) > 0.45


def test_the_scenarios_robot_wins_over_the_options(opened: Opened) -> None:
    robot = opened(Scenario(robot=RobotSection(version="v5", start=(0.2, 0.1, 90.0))))
    assert robot.info.version == "v5"
    base = robot.truth().base
    assert (base.x, base.y, base.yaw) == pytest.approx((0.2, 0.1, math.pi / 2.0))
    assert robot._simulated.total_mass_kg() == pytest.approx(
        sum(link.mass_kg for link in links("v5").values()), abs=1e-5
    )


def test_a_picture_may_be_the_background(tmp_path: Path, opened: Opened) -> None:
    stripes = np.zeros((64, 64, 3), dtype=np.uint8)
    stripes[:, ::2] = 255
    cv2.imwrite(str(tmp_path / "stripes.png"), stripes)
    scenario = Scenario(scene=SceneSection(background="stripes.png"))
    section = {"scenario": scenario, "scenario_folder": tmp_path}
    robot = open_robot("sim", OpenOptions(width=160, height=120, section=section))
    luma = robot.camera.next(1.0).yuyv[:25, :, 0]
    robot.close()
    plain = opened(Scenario()).camera.next(1.0).yuyv[:25, :, 0]
    assert luma.std() > 3.0 * plain.std()
