"""An upside-down sensor's picture."""

import numpy as np

from hal.video.rotation import upright
from hal.yuyv import rgb_from_yuyv, yuyv_from_rgb


def test_pixels_of_a_pair_change_places_and_chroma_does_not():
    # Y0 U0 Y1 V0 | Y2 U1 Y3 V1
    row = np.array([[[10, 110], [11, 210], [12, 111], [13, 211]]], dtype=np.uint8)
    assert upright(row).tolist() == [[[13, 111], [12, 211], [11, 110], [10, 210]]]


def test_it_is_the_turned_rgb_picture():
    rng = np.random.default_rng(0)
    # pairs of one colour, so that shared chroma loses nothing
    rgb = np.repeat(rng.integers(60, 190, (6, 5, 3), dtype=np.uint8), 2, axis=1)
    turned = rgb_from_yuyv(upright(yuyv_from_rgb(rgb)))
    assert np.array_equal(turned, rgb_from_yuyv(yuyv_from_rgb(rgb[::-1, ::-1])))


def test_twice_is_nothing():
    yuyv = np.random.default_rng(1).integers(0, 256, (48, 64, 2), dtype=np.uint8)
    assert np.array_equal(upright(upright(yuyv)), yuyv)
    assert not np.shares_memory(upright(yuyv), yuyv)
