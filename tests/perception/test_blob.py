"""Regions, boundaries and boxes against OpenCV and against shapes drawn by hand."""

import cv2
import numpy as np
import pytest

from naod.perception.blob import blob_of_mask, find_blob, oriented_box
from naod.perception.components import AREA, BOTTOM, LEFT, RIGHT, SUM_X, SUM_Y, TOP, components
from naod.perception.segmenter import Segmentation


@pytest.mark.parametrize("density", [0.2, 0.45, 0.6, 0.9])
def test_regions_equal_opencvs(density):
    rng = np.random.default_rng(int(100 * density))
    for shape in ((1, 1), (1, 40), (37, 1), (60, 80), (120, 160)):
        mask = (rng.random(shape) < density).astype(np.uint8)
        labels, table = components(mask)
        count, theirs, stats, centres = cv2.connectedComponentsWithStats(mask, connectivity=8)
        assert len(table) == count - 1
        pairs = np.unique(np.column_stack([labels.ravel(), theirs.ravel()]), axis=0)
        assert len(pairs) == len(np.unique(theirs))
        for ours, other in pairs[pairs[:, 0] > 0]:
            row = table[ours - 1]
            x, y, w, h, area = stats[other]
            assert row[AREA] == area
            assert (row[LEFT], row[TOP]) == (x, y)
            assert (row[RIGHT], row[BOTTOM]) == (x + w - 1, y + h - 1)
            centre = row[[SUM_X, SUM_Y]] / row[AREA]
            assert np.allclose(centre, centres[other])


def segmentation(mask, scale):
    height, width = mask.shape
    size = (int(width * scale), int(height * scale))
    return Segmentation(mask, 0.0, 1, scale, size, True)


def test_the_largest_region_in_full_pixels():
    mask = np.zeros((120, 160), np.uint8)
    mask[20:50, 40:60] = 1
    mask[80:90, 100:110] = 1
    blob = find_blob(segmentation(mask, 4.0))
    # reduced columns 40 to 59 are full columns 160 to 239: edges at 159.5 and 239.5
    assert np.allclose(blob.centre_px, (199.5, 139.5))
    assert blob.area_px == 20 * 30 * 16
    assert np.allclose(
        blob.corners_px, [(159.5, 79.5), (239.5, 79.5), (239.5, 199.5), (159.5, 199.5)], atol=1.5
    )
    assert blob.clipped == ()
    assert blob.boundary_px[:, 0].min() == 159.5
    assert blob.boundary_px[:, 1].max() == 199.5


def test_sides_of_the_picture_are_no_edges():
    mask = np.zeros((120, 160), np.uint8)
    mask[100:, :30] = 1
    blob = find_blob(segmentation(mask, 4.0))
    assert set(blob.clipped) == {"left", "bottom"}
    assert blob.boundary_px.min() > 0.0
    assert blob.boundary_px[:, 1].max() < 479.0
    full = find_blob(segmentation(np.ones((120, 160), np.uint8), 4.0))
    assert set(full.clipped) == {"left", "right", "top", "bottom"}
    assert len(full.boundary_px) == 0


def test_too_small_is_nothing():
    mask = np.zeros((120, 160), np.uint8)
    assert find_blob(segmentation(mask, 4.0)) is None
    mask[3, :11] = 1
    assert find_blob(segmentation(mask, 4.0), pixels_min=12) is None
    assert find_blob(segmentation(mask, 4.0), pixels_min=11) is not None


def test_stray_pixels_of_a_given_mask_are_left_out_and_its_parts_kept():
    mask = np.zeros((100, 100), np.uint8)
    mask[20:40, 20:40] = 1
    mask[45:60, 20:40] = 1
    mask[90, 90] = 1
    blob = blob_of_mask(mask)
    assert blob.area_px == 20 * 20 + 15 * 20
    assert blob.boundary_px.max() < 61.0


@pytest.mark.parametrize("roll_deg", [-40.0, -10.0, 0.0, 25.0, 44.0])
def test_a_turned_box_has_its_corners_in_order(roll_deg):
    roll = np.radians(roll_deg)
    R = np.array([[np.cos(roll), -np.sin(roll)], [np.sin(roll), np.cos(roll)]])
    upright = np.array([(-30.0, -50.0), (30.0, -50.0), (30.0, 50.0), (-30.0, 50.0)])
    corners = upright @ R.T + (200.0, 150.0)
    sides = np.linspace(corners, np.roll(corners, -1, axis=0), 40).reshape(-1, 2)
    assert np.allclose(oriented_box(sides), corners, atol=0.01)
