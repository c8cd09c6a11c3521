"""The benchmark of poses, small: right, and as sure as it may be."""

from dataclasses import replace

import pytest

from naod.bench.frames import Walk, WalkSettings
from naod.bench.poses import COLUMNS, Errors, measure, run

SHARP, BLURRED = 0.0, 0.033


@pytest.fixture(scope="module")
def rows():
    report = run(lambda told: None, WalkSettings(count=12), 2, exposures_s=(SHARP, BLURRED))
    return {row[0]: dict(zip(COLUMNS, row, strict=True)) for row in report.rows}


@pytest.mark.parametrize("thing", ["can", "board"])
def test_exact_poses_are_right_sharp_and_blurred(rows, thing):
    for name, most in ((f"{thing}, exact, 0 ms", 0.5), (f"{thing}, exact, 33 ms", 2.5)):
        row = rows[name]
        assert row["frames"] >= 12
        assert row["posed %"] == 100.0
        assert row["distance % median"] < most


@pytest.mark.parametrize("thing", ["can", "board"])
def test_sigma_is_of_the_size_of_the_errors(rows, thing):
    for name in (f"{thing}, exact, 0 ms", f"{thing}, exact, 33 ms"):
        assert 0.3 < rows[name]["error²/sigma² of 3"] < 10.0


def test_the_printed_cylinder_is_about_a_radius_too_far(rows):
    printed, exact = (rows[f"can, {one}, 0 ms"]["distance % median"] for one in ("paper", "exact"))
    assert printed > 3.0 * exact


def test_a_can_that_clutter_makes_seem_tilted_is_tried_less_tilted_too():
    """A descent stays at six degrees, where few edges fit; from half of them it does not."""
    taken = Walk(WalkSettings(count=18, seed=117)).taken("can", SHARP)
    errors = Errors()
    measure(replace(taken, frames=taken.frames[-1:]), {"exact": errors})
    assert errors.frames == 1
    assert errors.normalised[0] < 30.0
