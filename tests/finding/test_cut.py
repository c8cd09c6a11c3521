"""What the picture's border leaves of an object, and what that is worth."""

import numpy as np
import pytest
from drawn import CAMERA, draw, empty, segmented, standing

from naod.config import SegmentationConfig
from naod.finding.find import Expected, likeliest, scored_groups
from naod.finding.measure import SHARE
from naod.finding.regions import regions_of
from naod.pose.objects import Cylinder, Rectangle

CAN, BOARD = Cylinder(), Rectangle()
FAR_M = 0.8
PIXELS_MIN = SegmentationConfig().pixels_min


def seen_at(shape, x, y):
    """Share of the object in the picture, of its pixels, and as it is measured."""
    mask = draw(empty(), shape, standing(x, y, FAR_M))
    whole = draw(empty(), shape, standing(0.0, 0.0, FAR_M)).sum()
    segmentation = segmented(mask)
    expected = Expected(shape, CAMERA)
    scored = scored_groups(segmentation, regions_of(segmentation), expected, PIXELS_MIN)
    return mask.sum() / whole, scored.measures[0, SHARE], scored.cuts[0]


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


def test_the_less_is_seen_the_less_likely_it_is_the_object():
    half = CAMERA.width / 2.0 / CAMERA.fx * FAR_M
    said = []
    for shown in (0.2, 0.4, 0.6, 0.75):
        x = half + (0.5 - shown) * BOARD.width_m
        segmentation = segmented(draw(empty(), BOARD, standing(x, 0.0, FAR_M)))
        best = likeliest(segmentation, BOARD, CAMERA, None, PIXELS_MIN)
        said.append(best.probability)
    assert (np.diff(said) > 0.0).all()
