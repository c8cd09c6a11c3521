"""The loop keeps the object in light that changes slowly, and nothing else for it."""

import math
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from msgspec.structs import replace as with_fields

from hal.scenario import Scenario, SceneSection, ThingSection
from hal.types import PlanarMotion
from naod.config import CameraConfig, DaemonConfig, SegmentationConfig
from naod.experiment.opening import open_lockstep
from naod.experiment.person import mark, point_head
from naod.geometry.transforms import inverse
from naod.loop import core
from naod.perception.colour_model import Region
from naod.perception.learning import learn_model
from naod.pose.contour import corners_px

FPS = 2
MINUTE = 60 * FPS
# the tolerance for light that a model has by itself would hide what following it does
STRICT = with_fields(
    DaemonConfig(),
    camera=CameraConfig(width=320, height=240, fps=FPS),
    segmentation=SegmentationConfig(light_std=0.0),
)
TOLERANT = with_fields(STRICT, segmentation=SegmentationConfig())
CAN = ThingSection(radius_m=0.033, height_m=0.115, colour=(200, 20, 30), position=(0.6, 0.0, 0.46))
BEFORE_IT = ThingSection(
    radius_m=0.033, height_m=0.115, colour=(150, 15, 22), position=(0.37, -0.138, 0.46)
)
"""Like the can, but as if it stood in half the light."""

HIDDEN = PlanarMotion(0.0, -0.36, math.atan2(0.36, 0.6))
"""From here the other red thing stands before the can."""


@pytest.fixture
def started(request):
    runs = []

    def start(kind, light_drift, *others, config=STRICT):
        scene = SceneSection(light_drift=light_drift)
        scenario = Scenario(object=CAN, distractor=others, scene=scene)
        run = open_lockstep(config, scenario, Path(), 1, False)
        runs.append(run)
        run.tick()
        point_head(run)
        tick = run.tick()
        region = mark(tick.truth, run.equipment.shape, run.equipment.camera)
        label = Region(region.x, region.y, region.width, region.height)
        model = learn_model([tick.seen.frame.yuyv], label, kind)
        run.state = replace(run.state, model=model, mode="track", phase="centre")
        return run

    yield start
    for run in runs:
        run.robot.close()


def overlap(run, tick):
    """Of the blob's box and the true one, shared area over area of both; 0 when not found."""
    if tick.sighting is None:
        return 0.0
    T = inverse(tick.truth.T_world_camera) @ tick.truth.T_world_object
    boxes = (
        tick.sighting.blob.corners_px,
        corners_px(run.equipment.shape, T, run.equipment.camera),
    )
    a, b = (box.astype(np.float32) for box in boxes)
    shared = cv2.intersectConvexConvex(a, b)[0]
    return shared / (cv2.contourArea(a) + cv2.contourArea(b) - shared)


def overlaps_of(run, ticks):
    return [overlap(run, run.tick()) for _ in range(ticks)]


@pytest.mark.parametrize(
    ("kind", "light_drift"),
    [
        ("table", -0.3),
        ("gaussian", -0.3),
        pytest.param("mixture", -0.3, marks=pytest.mark.slow),
        pytest.param("gaussian", 0.3, marks=pytest.mark.slow),
    ],
)
def test_the_object_is_kept_while_the_light_changes(started, kind, light_drift):
    run = started(kind, light_drift)
    kept = overlaps_of(run, MINUTE + MINUTE // 4)
    assert min(kept) > 0.7
    assert run.state.lost_count == 0
    assert not [event for event in run.events if event.kind == "colour_doubtful"]
    # what a camera's curve makes of this much less or more light
    assert run.state.drift.log == pytest.approx(math.log(1.0 + 1.25 * light_drift) / 2.2, abs=0.06)


def test_it_would_be_lost_without_following(started, monkeypatch):
    monkeypatch.setattr(core, "follow_light", lambda state, *_: state)
    run = started("gaussian", -0.3)
    alone = overlaps_of(run, MINUTE + MINUTE // 4)
    assert min(alone[: MINUTE // 6]) > 0.7
    assert max(alone[-MINUTE // 12 :]) < 0.5


def test_another_red_thing_before_it_is_doubted_once_and_not_followed(started):
    run = started("table", -0.3, BEFORE_IT, config=TOLERANT)
    assert min(overlaps_of(run, MINUTE // 3)) > 0.7
    before = run.state.drift.log
    run.robot.place(HIDDEN)
    sightings = [run.tick().sighting for _ in range(MINUTE // 4)]
    assert sum(sighting is not None for sighting in sightings) > MINUTE // 5, "nothing to doubt"
    assert run.state.drift.doubtful
    assert abs(run.state.drift.log - before) < 0.05
    run.robot.place(PlanarMotion(0.0, 0.0, 0.0))
    assert np.median(overlaps_of(run, MINUTE // 3)[-10:]) > 0.7
    assert not run.state.drift.doubtful
    assert [event.kind for event in run.events].count("colour_doubtful") == 1
