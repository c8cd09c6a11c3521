"""The benchmark of rooms, small: our kinds of model at home and in rooms they never saw."""

import math

import pytest

from naod.bench.finders import finders_of, seen_again
from naod.bench.frames import Walk, WalkSettings
from naod.bench.poses import band
from naod.bench.room import UNSEEN
from naod.bench.rooms import run, tally

SMALL = WalkSettings(count=8, size=(320, 240))
AWAY = WalkSettings(count=8, size=(320, 240), seed=7, room=UNSEEN["other walls"])


@pytest.fixture(scope="module", params=["can", "board"])
def walks(request):
    home = Walk(WalkSettings(**{**_fields(SMALL), "thing": request.param}))
    away = Walk(WalkSettings(**{**_fields(AWAY), "thing": request.param}))
    return home, away, finders_of(home.taken("home", 0.0))


def _fields(settings):
    return {name: getattr(settings, name) for name in settings.__struct_fields__}


def test_the_table_survives_the_blur_of_a_walk(walks):
    home, _, finders = walks
    blurred = home.taken("home", 0.033)
    table, gaussian = (tally(finders[kind], blurred) for kind in ("table", "gaussian"))
    assert table.lost == 0.0
    assert table.box_iou > gaussian.box_iou - 0.01


def test_it_is_no_worse_when_sharp(walks):
    home, _, finders = walks
    sharp = home.taken("home", 0.0)
    table, gaussian = (tally(finders[kind], sharp) for kind in ("table", "gaussian"))
    assert table.lost == 0.0
    assert table.box_iou >= gaussian.box_iou - 0.01


def test_it_is_never_much_worse_in_a_room_it_never_saw(walks):
    _, away, finders = walks
    blurred = away.taken("away", 0.033)
    table, gaussian = (tally(finders[kind], blurred) for kind in ("table", "gaussian"))
    assert table.lost <= gaussian.lost
    assert table.box_iou > gaussian.box_iou - 0.03


def test_rows_are_whole_and_who_was_taught_there_is_the_measure():
    tiny = WalkSettings(count=2, size=(320, 240))
    report = run(lambda _: None, tiny, {"home": tiny.room}, ("can",), empty_rooms=2)
    assert all(len(row) == len(report.columns) for row in report.rows)
    assert {row[report.columns.index("of learnt there")] for row in report.rows} <= {1.0, None}


def test_who_saw_nothing_for_a_while_finds_the_object_again(walks):
    home, _, finders = walks
    gone, back = home.without("gone", 0.0), home.taken("back", 0.0)
    again = seen_again(finders["gaussian"], gone.frames, back.frames)
    assert again is not None
    assert again <= 2


def test_the_band_of_means_is_that_of_random_ones():
    import numpy as np

    rng = np.random.default_rng(3)
    means = (rng.normal(size=(4000, 50, 3)) ** 2).sum(axis=2).mean(axis=1)
    low, high = np.quantile(means, (0.025, 0.975))
    assert band(50) == pytest.approx((low, high), rel=0.02)
    assert all(math.isfinite(x) for x in band(2))
