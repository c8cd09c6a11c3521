"""Regions that a segmenter saw against those of its mask, and cores of regions."""

import cv2
import numpy as np
from drawn import CAMERA, RED, SURE, draw, empty, painted, standing
from drawn import MODEL as OF_CAN

from naod.config import SegmentationConfig
from naod.finding.find import find_object
from naod.finding.hue import Colours
from naod.finding.regions import cores_of, regions_of
from naod.perception.blob import evidence
from naod.perception.colour_model import ColourModel
from naod.perception.components import components
from naod.perception.energy import STEPS
from naod.perception.segmenter import Segmentation, Segmenter
from naod.pose.objects import Cylinder

MODEL = ColourModel(
    mean=(90.0, 110.0, 200.0),
    covariance=((200.0, 0.0, 0.0), (0.0, 60.0, 0.0), (0.0, 0.0, 60.0)),
)

WALL = (95.0, 96.0, 185.0)
"""Nearly the can's colour."""


def patches():
    """Patches of the model's colour in a grey picture, (480, 640, 2)."""
    yuyv = np.full((480, 640, 2), 128, np.uint8)
    for y, x, height, width in ((40, 60, 100, 80), (300, 400, 60, 120), (200, 0, 40, 40)):
        inside = yuyv[y : y + height, x : x + width]
        inside[..., 0], inside[:, ::2, 1], inside[:, 1::2, 1] = 90, 110, 200
    return yuyv


def merged(T):
    """A can before a wall that is a little like it: one region. Where the can is, and that."""
    can = draw(empty(), Cylinder(), T) > 0
    mask = can.astype(np.uint8)
    mask[20:80, 60:130] = 1
    differences = np.where(mask > 0, np.int32(-2 * STEPS), np.int32(SURE))
    differences[can] = -SURE
    return can, Segmentation(mask, 0.0, 1, 4.0, (640, 480), True, differences.astype(np.int32))


def test_what_the_segmenter_saw_is_what_its_mask_shows():
    for optimiser in ("exact", "icm"):
        settings = SegmentationConfig(optimiser=optimiser)
        segmentation = Segmenter(MODEL, settings, (640, 480)).segment(patches())
        seen = regions_of(segmentation)
        labels, table = components(segmentation.mask)
        assert len(table) == 3
        assert np.array_equal(seen.labels, labels)
        assert np.array_equal(seen.table[:, :7], table)
        assert np.allclose(seen.told, evidence(labels, segmentation.differences, len(table)))


def test_regions_stay_when_the_segmenter_goes_on():
    segmenter = Segmenter(MODEL, SegmentationConfig(), (640, 480))
    seen = regions_of(segmenter.segment(patches()))
    before = seen.labels.copy(), seen.table.copy()
    for _ in range(4):
        segmenter.segment(np.full((480, 640, 2), 128, np.uint8))
    assert np.array_equal(seen.labels, before[0])
    assert np.array_equal(seen.table, before[1])


def test_a_core_is_what_is_surer():
    can, segmentation = merged(standing(0.0, 0.0, 0.7))
    regions = regions_of(segmentation)
    assert len(regions.table) == 1
    cores = cores_of(regions)
    assert len(cores.table) == 1
    around = np.ones((3, 3), np.uint8)
    beside = cv2.dilate(can.astype(np.uint8), around) > 0
    last = cv2.dilate((regions.labels == 0).astype(np.uint8), around) > 0
    assert np.array_equal(cores.labels > 0, can | (beside & last & (regions.labels > 0)))


def test_a_can_before_a_wall_of_nearly_its_colour():
    T = standing(0.0, 0.0, 0.7)
    can, segmentation = merged(T)
    picture = painted(segmentation.mask, WALL)
    own = painted(can.astype(np.uint8), RED)
    picture[np.kron(can, np.ones((4, 4))) > 0] = own[np.kron(can, np.ones((4, 4))) > 0]
    colours = Colours(picture, OF_CAN)
    best = find_object(
        segmentation, Cylinder(), CAMERA, None, SegmentationConfig(), colours=colours
    )
    assert np.allclose(best.blob.centre_px, CAMERA.project(T[:3, 3])[0], atol=4.0)
