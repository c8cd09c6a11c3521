"""Which regions are the object, among other things of its colour."""

import msgspec
import numpy as np
import pytest
from drawn import CAMERA, MODEL, RED, SMALL, draw, empty, painted, segmented, standing

from naod.config import SegmentationConfig
from naod.finding.find import Expected, find_object, likeliest, scored_groups
from naod.finding.groups import GROUPS_MAX
from naod.finding.hue import Colours
from naod.finding.presence import distance_m
from naod.finding.regions import regions_of
from naod.perception.blob import find_blob
from naod.pose.objects import Cylinder, Rectangle
from naod.pose.prior import Prior

SETTINGS = SegmentationConfig()
CAN, BOARD = Cylinder(), Rectangle()


def found(mask, shape=CAN, prior=None):
    colours = Colours(painted(mask, RED), MODEL)
    return find_object(segmented(mask), shape, CAMERA, prior, SETTINGS, colours=colours)


def expected_at(T, age_s=0.1, sigma_m=0.02):
    return Prior(T, np.diag([sigma_m**2] * 3 + [0.01] * 3), age_s)


def centre_of(T):
    return CAMERA.project(T[:3, 3])[0]


def ribboned(T):
    """A can whose white ribbon leaves two pieces of red, and its box in mask pixels."""
    mask = draw(empty(), CAN, T)
    rows = np.flatnonzero(mask.any(axis=1))
    middle = (rows[0] + rows[-1]) // 2
    mask[middle - 1 : middle + 2] = 0
    return mask


def test_both_sides_of_a_ribbon_are_one_can():
    T = standing(0.1, 0.02, 0.6)
    mask = ribboned(T)
    mask[80:110, 20:60] = 1
    assert find_blob(segmented(mask)).centre_px[0] < 300.0
    best = found(mask)
    assert best.parts == 2
    assert np.allclose(best.blob.centre_px, centre_of(T), atol=4.0)
    whole = found(draw(empty(), CAN, T)).blob
    assert np.allclose(best.blob.corners_px, whole.corners_px, atol=4.0)


@pytest.mark.parametrize("box", [(10, 100, 20, 24), (5, 60, 12, 100), (30, 60, 20, 90)])
def test_a_can_among_larger_things_of_its_colour(box):
    """A rod, a shelf and a block: each has more of the colour than the can."""
    top, bottom, left, right = box
    T = standing(0.2, 0.1, 0.9)
    mask = draw(empty(), CAN, T)
    mask[top:bottom, left:right] = 1
    best = found(mask)
    assert best.parts == 1
    assert np.allclose(best.blob.centre_px, centre_of(T), atol=4.0)


@pytest.mark.parametrize("height", [4, 110])
def test_other_things_alone_are_not_the_can(height):
    mask = empty()
    mask[5 : 5 + height, 70:84] = 1
    best = likeliest(segmented(mask), CAN, CAMERA, None, SETTINGS.pixels_min)
    assert best.probability < SETTINGS.presence_min
    assert found(mask) is None


def test_two_cans_side_by_side_are_not_one():
    mask = empty()
    for x in (-0.06, 0.06):
        draw(mask, CAN, standing(x, 0.0, 0.6))
    assert found(mask).parts == 1


@pytest.mark.parametrize(("shape", "z"), [(CAN, 0.5), (CAN, 1.2), (BOARD, 0.9), (BOARD, 2.0)])
def test_the_implied_distance_is_the_true_one(shape, z):
    segmentation = segmented(draw(empty(), shape, standing(0.0, 0.05, z)))
    expected = Expected(shape, CAMERA)
    scored = scored_groups(segmentation, regions_of(segmentation), expected, SETTINGS.pixels_min)
    assert distance_m(scored.measures, SMALL.fx)[0] == pytest.approx(z, rel=0.1)
    assert found(segmentation.mask, shape) is not None


def test_too_large_for_any_distance_is_not_the_object():
    """A board-shaped thing that would have to stand before the robot's nose."""
    tiny = Rectangle(width_m=0.03, height_m=0.02)
    mask = draw(empty(), BOARD, standing(0.0, 0.0, 0.6))
    assert found(mask, BOARD) is not None
    assert found(mask, tiny) is None


@pytest.mark.parametrize("x", [-0.32, 0.32])
def test_half_cut_off_by_the_border_it_is_still_found(x):
    mask = draw(empty(), CAN, standing(x, 0.05, 0.6))
    assert mask[:, [0, -1]].any()
    best = found(mask)
    assert best.blob.clipped == (("left",) if x < 0.0 else ("right",))


@pytest.mark.parametrize("x", [-0.34, 0.34])
def test_a_glimpse_is_found_where_it_is_expected(x):
    T = standing(x, 0.05, 0.6)
    mask = draw(empty(), CAN, T)
    assert found(mask) is None
    assert found(mask, prior=expected_at(T)) is not None


def test_of_two_alike_the_expected_one():
    places = [standing(x, 0.0, 0.8) for x in (-0.2, 0.2)]
    mask = draw(draw(empty(), CAN, places[0]), CAN, places[1])
    for T in places:
        best = found(mask, prior=expected_at(T))
        assert np.allclose(best.blob.centre_px, centre_of(T), atol=4.0)


def test_expectation_counts_less_as_it_ages():
    T = standing(0.0, 0.0, 0.8)
    mask = draw(empty(), CAN, T)
    without = found(mask).probability
    agrees = [found(mask, prior=expected_at(T, age)).probability for age in (0.1, 4.0, 60.0)]
    assert agrees[0] > agrees[1] > without
    assert agrees[2] == pytest.approx(without, abs=1e-3)
    elsewhere = expected_at(standing(0.3, 0.2, 1.5))
    assert likeliest(segmented(mask), CAN, CAMERA, elsewhere, 12).probability < without


def test_without_shape_colour_decides():
    mask = draw(empty(), CAN, standing(0.0, 0.0, 0.6))
    mask[60:110, 10:60] = 1
    best = find_object(segmented(mask), None, None, None, SETTINGS)
    assert best.probability > 0.5
    assert best.parts == 1


def test_without_shape_a_large_thing_in_shades_is_taken_before_a_small_pure_one():
    small, large = empty(), empty()
    small[10:18, 140:148] = 1
    large[60:110, 10:60] = 1
    sure = segmented(small | large).differences
    shaded = np.where(large > 0, sure * 3 // 4, sure).astype(np.int32)
    segmentation = msgspec.structs.replace(segmented(small | large), given=shaded)
    best = find_object(segmentation, None, None, None, SETTINGS)
    assert best.blob.centre_px[0] < 320.0
    faint = np.where(large > 0, sure // 6, sure).astype(np.int32)
    segmentation = msgspec.structs.replace(segmentation, given=faint)
    best = find_object(segmentation, None, None, None, SETTINGS)
    assert best.blob.centre_px[0] > 320.0


def test_clutter_is_looked_at_within_bounds():
    mask = (np.random.default_rng(1).random((120, 160)) < 0.3).astype(np.uint8)
    segmentation = segmented(mask)
    scored = scored_groups(segmentation, regions_of(segmentation), Expected(CAN, CAMERA), 1)
    assert 0 < len(scored.groups) <= GROUPS_MAX
    assert found(empty()) is None
