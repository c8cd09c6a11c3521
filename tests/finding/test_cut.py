"""What the picture's border leaves of an object, and what that is worth."""

import numpy as np
import pytest
from drawn import CAMERA, draw, empty, segmented, standing

from naod.config import SegmentationConfig
from naod.finding.find import Expected, scored_groups
from naod.finding.measure import SHARE
from naod.finding.presence import GLIMPSE_COST
from naod.finding.regions import regions_of
from naod.pose.objects import Cylinder, Rectangle

CAN, BOARD = Cylinder(), Rectangle()
FAR_M = 0.8
PIXELS_MIN = SegmentationConfig().pixels_min


def scored_at(shape, x, y):
    segmentation = segmented(draw(empty(), shape, standing(x, y, FAR_M)))
    expected = Expected(shape, CAMERA)
    return scored_groups(segmentation, regions_of(segmentation), expected, PIXELS_MIN)


def seen_at(shape, x, y):
    """Share of the object in the picture, of its pixels, and as it is measured."""
    seen, whole = (draw(empty(), shape, standing(*at, FAR_M)).sum() for at in ((x, y), (0.0, 0.0)))
    scored = scored_at(shape, x, y)
    return seen / whole, scored.measures[0, SHARE], scored.cuts[0]


@pytest.mark.parametrize("shape", [CAN, BOARD])
@pytest.mark.parametrize("shift", np.linspace(-0.8, 0.8, 9))
def test_the_share_that_the_border_leaves(shape, shift):
    half = CAMERA.width / 2.0 / CAMERA.fx * FAR_M
    width = 2.0 * shape.radius_m if shape is CAN else shape.width_m
    true, measured, cut = seen_at(shape, half + 0.5 * shift * width, 0.0)
    assert cut
    assert measured == pytest.approx(true, abs=0.1)


def test_a_board_half_below_the_picture():
    low = CAMERA.height / 2.0 / CAMERA.fy * FAR_M
    true, measured, cut = seen_at(BOARD, 0.0, low)
    assert cut
    assert true == pytest.approx(0.5, abs=0.05)
    assert measured == pytest.approx(true, abs=0.1)


@pytest.mark.parametrize("shape", [CAN, BOARD])
def test_what_is_not_cut_is_all_there(shape):
    _, measured, cut = seen_at(shape, 0.0, 0.0)
    assert not cut
    assert measured == 1.0


@pytest.mark.parametrize("shown", [0.2, 0.35, 0.6, 0.75])
def test_a_glimpse_at_the_side_counts_against_it_by_what_lacks_of_half(shown):
    half = CAMERA.width / 2.0 / CAMERA.fx * FAR_M
    offset = scored_at(BOARD, half + (0.5 - shown) * BOARD.width_m, 0.0).offsets[0]
    assert offset == pytest.approx(-GLIMPSE_COST * max(0.5 - shown, 0.0), abs=0.2)


def test_a_glimpse_below_does_not():
    """There the head may not turn far enough to see more."""
    low = CAMERA.height / 2.0 / CAMERA.fy * FAR_M + 0.25 * BOARD.height_m
    scored = scored_at(BOARD, 0.0, low)
    assert scored.measures[0, SHARE] < 0.4
    assert scored.offsets[0] == pytest.approx(0.0, abs=1e-6)
