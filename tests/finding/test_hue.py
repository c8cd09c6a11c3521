"""Hue and tone of what is in a picture, against numpy's way to the same numbers."""

import msgspec
import numpy as np
import pytest
from drawn import CAMERA, MODEL, RED, draw, empty, painted, segmented, standing

from hal.yuyv import yuv_from_rgb
from naod.config import SegmentationConfig
from naod.finding.find import find_object, likeliest
from naod.finding.hue import CLIP, HUE_STD, LEVELS_STD, PEAK_MIN, TONE_STD, Colours, look_at_middle
from naod.finding.rooms import developed
from naod.perception.colour_table import CELLS, cells_of
from naod.perception.colour_table_learning import table_model
from naod.perception.energy import STEPS
from naod.pose.objects import Cylinder

SETTINGS = SegmentationConfig()
BOX = np.array([80.0, 60.0, 0.0, 1.0, 20.0, 30.0])
WANTED = np.array([False, True])


def looked(mask, colour, model=MODEL, box=BOX):
    colours = Colours(painted(mask, colour), model)
    return look_at_middle(colours.picture, mask.astype(np.int32), WANTED, box, colours.own)


def in_light(factor):
    return np.array(RED) * factor + (0.0, 128.0 * (1.0 - factor), 128.0 * (1.0 - factor))


def block():
    mask = empty()
    mask[40:81, 65:96] = 1
    return mask


def test_hue_is_the_angle_between_chromas():
    mask = block()
    for u, v in ((106.0, 206.0), (119.0, 223.0), (90.0, 190.0), (140.0, 100.0)):
        own, seen = np.array(RED[1:]) - 128.0, np.array([u, v]) - 128.0
        lengths = np.linalg.norm(own), np.linalg.norm(seen)
        cosine = own @ seen / (lengths[0] * lengths[1])
        sigma = np.hypot(HUE_STD, LEVELS_STD / min(lengths))
        hue, tone = looked(mask, (80.0, u, v))
        assert hue == pytest.approx(np.arccos(min(cosine, 1.0)) / sigma, abs=1e-4)
        expected = np.log(lengths[1] / 80.0) - np.log(lengths[0] / RED[0])
        sigma = np.hypot(TONE_STD, LEVELS_STD / min(lengths))
        assert tone == pytest.approx(expected / sigma, abs=1e-6)


@pytest.mark.parametrize("factor", [0.7, 1.0, 1.3])
def test_light_changes_neither(factor):
    hue, tone = looked(block(), in_light(factor))
    assert hue < 0.3
    assert abs(tone) < 0.3


def test_a_picture_whose_rows_are_no_whole_blocks_is_looked_at_where_the_mask_says():
    mask = block()[:107]
    # 427 rows of blocks of four: the last block has three
    tall = painted(block(), RED)[:427]
    own = Colours(tall, MODEL)
    seen = look_at_middle(own.picture, mask.astype(np.int32), WANTED, BOX, own.own)
    assert seen == pytest.approx(looked(block(), RED), abs=1e-9)
    low = np.zeros((107, 160), np.int32)
    low[98:, 65:96] = 1
    red = painted((np.pad(low, ((0, 13), (0, 0))) > 0).astype(np.uint8), RED)[:427]
    box = np.array([80.0, 102.0, 0.0, 1.0, 20.0, 8.0])
    found = Colours(red, MODEL)
    hue, tone = look_at_middle(found.picture, low, WANTED, box, found.own)
    assert hue < 0.3
    assert abs(tone) < 0.3


def test_only_what_is_wanted_counts():
    mask = block()
    assert looked(1 - mask, RED) == (0.0, 0.0)
    turned = BOX.copy()
    turned[2:4] = np.sin(0.6), np.cos(0.6)
    assert looked(mask, RED, box=turned)[0] < 0.1


def test_an_object_of_many_colours_has_hardly_a_hue():
    wide = tuple(tuple(400.0 * (a == b) for b in range(3)) for a in range(3))
    many = msgspec.structs.replace(MODEL, covariance=wide)
    purple = (80.0, 140.0, 190.0)
    assert looked(block(), purple, many)[0] < 0.5 * looked(block(), purple)[0]


def test_how_sure_a_table_is_of_the_objects_own_colour():
    for nats, peak in ((4.0, 4.0), (1.0, PEAK_MIN), (9.0, CLIP)):
        cells = np.zeros(CELLS, np.int16)
        cells[cells_of(np.array(RED, np.float32))] = -nats * STEPS
        colours = Colours(painted(block(), RED), table_model(MODEL, cells))
        assert colours.peak == pytest.approx(peak)
    assert Colours(painted(block(), RED), MODEL).peak == CLIP


def test_of_another_hue_it_is_not_the_object():
    mask = draw(empty(), Cylinder(), standing(0.05, 0.0, 0.8))
    segmentation = segmented(mask)
    likely = []
    for u, v in ((106.0, 206.0), (119.0, 223.0)):
        colours = Colours(painted(mask, (65.0, u, v)), MODEL)
        known = (Cylinder(), CAMERA, None)
        likely.append(likeliest(segmentation, *known, 12, 0.0, colours).probability)
        found = find_object(segmentation, *known, SETTINGS, 0.0, colours)
        assert (found is None) == (u > 110.0)
    assert likely[0] > likely[1] + 0.4


def test_a_tint_is_a_gain_on_light():
    """Grey in redder light has a redder chroma; none leaves a picture alone."""
    picture = painted(block(), RED)
    assert developed(picture, (0.0, 0.0), 0.0) is picture
    redder = developed(picture, (0.1, 0.0), 0.0)
    grey = redder[0, :2, 1].astype(float) - 128.0
    gain = np.exp(0.1 / 2.2)
    expected = yuv_from_rgb(np.array([[128.0 * gain, 128.0, 128.0]]))[0, 1:] - 128.0
    assert np.allclose(grey, expected, atol=1.6)


def test_contrast_is_an_exponent():
    """Greys stay grey; on a curve that is nearly a power, their levels are raised to a power."""
    picture = np.full((4, 4, 2), 128, np.uint8)
    harder = developed(picture, (0.0, 0.0), 0.1)
    assert (harder[..., 1] == 128).all()
    assert harder[0, 0, 0] == pytest.approx(255.0 * (128.0 / 255.0) ** np.exp(0.1), abs=4.0)
