"""Where a smeared step would go in the pace it begins with: what is just outside an edge."""

import numpy as np
import pytest
from test_profile import GREY, RED, STEP_PX, profile

from naod.perception.encoding import mixture_scores
from naod.perception.placing import SHARES
from naod.perception.profile import contrast_of, plateau
from naod.perception.steps import crossing, goes_to, width_of

FEW = 4


def told(colours, blur_px):
    """How far the step goes, and its width, px."""
    sides, scatter, curve = np.empty((3, 3)), np.zeros((3, 3)), np.empty(SHARES)
    count = len(colours)
    plateau(colours, 0, FEW, sides[0], scatter)
    plateau(colours, count - FEW, count, sides[1], scatter)
    assert contrast_of(sides[0], sides[1], scatter, sides[2]) > 3.0
    mixture_scores(sides[0], sides[1], sides[2], curve)
    scores = np.empty(count)
    at, slope = crossing(colours, count, sides[0], sides[2], curve[SHARES // 2], STEP_PX, scores)
    return (
        goes_to(scores, count, at, curve, STEP_PX, blur_px),
        width_of(scores, count, at, slope, curve, STEP_PX),
    )


@pytest.mark.parametrize("blur_px", [8.0, 12.0, 16.0])
def test_before_one_thing_it_goes_to_its_end(blur_px):
    colours, _ = profile(0.0, blur_px)
    goes, width = told(colours, blur_px)
    assert goes == pytest.approx(1.0, abs=0.08)
    assert width == pytest.approx(blur_px, rel=0.15)


def test_before_a_strip_that_is_half_way_it_goes_half_as_far():
    half = tuple(0.5 * (a + b) for a, b in zip(RED, GREY, strict=True))
    colours, _ = profile(7.0, 10.0, strip=half)
    goes, _ = told(colours, 10.0)
    assert goes == pytest.approx(0.5, abs=0.12)
