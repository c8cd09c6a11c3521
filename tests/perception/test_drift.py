"""The colour follows slow light and nothing else."""

import math

import numpy as np
import pytest

from hal.backends import OpenOptions, open_studio
from hal.scenario import Scenario, SceneSection, ThingSection
from naod.config import SegmentationConfig
from naod.perception.blob import blob_of_mask, find_blob
from naod.perception.colour_model import ColourModel, Region
from naod.perception.drift import (
    DOUBT_BELOW,
    LOG_MAX,
    NORMAL_LOOKS,
    Drift,
    followed,
    relit,
    seen_colour,
)
from naod.perception.energy import Singletons
from naod.perception.learning import KINDS, learn_model
from naod.perception.segmenter import Segmenter

MODEL = ColourModel(
    mean=(90.0, 108.0, 190.0), covariance=((40.0, 0, 0), (0, 20.0, 0), (0, 0, 20.0))
)
RED = np.array([90.0, -20.0, 62.0])
SECOND = 1_000_000_000
AS_LEARNT = SegmentationConfig(light_std=0.0)


def run(looks, drift=None, period_s=0.1, begin_s=0.0):
    drift = drift or Drift.of(MODEL)
    for n, look in enumerate(looks):
        drift = followed(drift, look, round((begin_s + n * period_s) * SECOND))
    return drift


def light_from(factor, count):
    """Looks in light that goes evenly, in the logarithm, from 1 to `factor`, with shading."""
    rng = np.random.default_rng(count)
    logs = np.linspace(0.0, math.log(factor), count) + rng.normal(0.0, 0.02, count)
    return [RED * math.exp(log) for log in logs]


@pytest.mark.parametrize("factor", [0.75, 1.25])
def test_slow_light_is_followed(factor):
    drift = run(light_from(factor, 1200))
    assert drift.log == pytest.approx(math.log(factor), abs=0.03)
    assert drift.trust > 0.9
    assert drift.lit.mean[0] == pytest.approx(MODEL.mean[0] * factor, rel=0.05)


def test_light_that_stays_changes_nothing():
    drift = run(light_from(1.0, 600))
    assert drift.lit is MODEL


@pytest.mark.parametrize(
    "other", [RED * 0.6, RED * 1.5, np.array([90.0, 5.0, 62.0]), np.array([90.0, -20.0, 25.0])]
)
def test_something_else_is_not_followed_and_soon_doubted(other):
    before = run(light_from(1.0, 60))
    after = run([other] * 8, before, begin_s=6.0)
    assert after.log == pytest.approx(before.log, abs=0.01)
    assert not after.doubtful
    later = run([other] * 60, after, begin_s=7.0)
    assert later.doubtful
    assert later.trust < DOUBT_BELOW
    assert later.log == pytest.approx(before.log, abs=0.01)
    back = run(light_from(1.0, 100), later, begin_s=14.0)
    assert not back.doubtful


def test_a_lamp_switched_off_is_doubted_first_and_believed_within_a_minute():
    before = run(light_from(1.0, 60))
    doubted = run([RED * 0.75] * 100, before, begin_s=6.0)
    assert doubted.doubtful
    assert doubted.log == pytest.approx(before.log, abs=0.01)
    believed = run([RED * 0.75] * 500, doubted, begin_s=16.0)
    assert not believed.doubtful
    assert believed.log == pytest.approx(math.log(0.75), abs=0.05)


def test_it_never_goes_farther_than_it_may_and_says_so():
    drift = run(light_from(0.2, 6000))
    assert abs(drift.log) <= LOG_MAX
    assert drift.doubtful


def test_what_is_not_seen_is_not_learnt():
    drift = run(light_from(1.0, NORMAL_LOOKS))
    assert followed(drift, None, 5 * SECOND) is drift


@pytest.fixture(scope="module")
def pictures():
    """The same view in ever less light, then in more, and the object's mask."""
    views = []
    for light in (1.0, 0.87, 0.75, 0.65, 0.57, 0.5, 0.43, 0.37, 1.0, 1.15, 1.3, 1.5):
        scenario = Scenario(
            object=ThingSection(),
            scene=SceneSection(light=light),
            # another red thing beside it, half as bright, wider
            distractor=(
                ThingSection(
                    radius_m=0.05, height_m=0.1, colour=(120, 12, 18), position=(1.25, 0.16, 0.45)
                ),
            ),
        )
        options = OpenOptions(
            width=320,
            height=240,
            section={"scenario": scenario, "scenario_folder": None, "seed": 1},
        )
        studio = open_studio("sim", options)
        T = np.eye(4)
        T[:3, :3] = [[0, 0, 1], [-1, 0, 0], [0, -1, 0]]
        T[:3, 3] = studio.T_world_object[:3, 3] - (0.6, 0.0, 0.0)
        views.append((studio.frame_at(T, noise_seed=round(100 * light)), studio.mask_at(T)))
    return views


def overlap(box, truth):
    import cv2

    a, b = box.astype(np.float32), truth.astype(np.float32)
    shared = cv2.intersectConvexConvex(a, b)[0]
    return shared / (cv2.contourArea(a) + cv2.contourArea(b) - shared)


def walk_through(pictures, kind, follow):
    yuyv, mask = pictures[0]
    rows, columns = np.nonzero(mask)
    x, y = int(np.quantile(columns, 0.25)), int(np.quantile(rows, 0.25))
    region = Region(x, y, int(np.quantile(columns, 0.75)) - x, int(np.quantile(rows, 0.75)) - y)
    model = learn_model([yuyv], region, kind)
    drift, overlaps = Drift.of(model), []
    truth = blob_of_mask(mask).corners_px
    now, lit, segmenter = 0, None, None
    for n, (picture, _) in enumerate(pictures):
        if n == 8:
            drift = Drift.of(model)
        for _ in range(24 if follow else 1):
            now += SECOND // 2
            if lit is not drift.lit:
                lit, segmenter = drift.lit, Segmenter(drift.lit, AS_LEARNT, (320, 240))
            segmentation = segmenter.segment(picture)
            blob = find_blob(segmentation)
            if blob is not None and follow:
                drift = followed(drift, seen_colour(picture, segmentation, blob), now)
        overlaps.append(0.0 if blob is None else overlap(blob.corners_px, truth))
    return overlaps


@pytest.mark.parametrize("kind", KINDS)
def test_the_box_stays_on_the_object_in_slow_light(pictures, kind):
    kept = walk_through(pictures, kind, True)
    alone = walk_through(pictures, kind, False)
    assert min(kept) > 0.8, kept
    assert min(kept) >= min(alone) - 0.02
    if kind != "table":
        assert min(alone) < 0.6, "too easy to show anything"


@pytest.mark.parametrize("kind", KINDS)
def test_a_model_in_other_light_prices_a_colour_as_the_learnt_one_did(pictures, kind):
    yuyv, mask = pictures[0]
    rows, columns = np.nonzero(mask)
    region = Region(int(columns.mean()) - 8, int(rows.mean()) - 12, 16, 24)
    model = learn_model([yuyv], region, kind)
    factor = 0.75
    zero = np.array((0, 128, 128), np.float32)
    centre = (np.array(model.mean, np.float32) - zero)[None, None]
    learnt, lit = np.empty((1, 1), np.int32), np.empty((1, 1), np.int32)
    Singletons(model, 16.6, 0.12).differences(centre + zero, learnt)
    Singletons(relit(model, factor), 16.6, 0.12).differences(factor * centre + zero, lit)
    assert learnt[0, 0] < 0
    assert lit[0, 0] == pytest.approx(learnt[0, 0], abs=400)
