"""Parts of regions between the picture's edges, against numpy and OpenCV, and what they are for."""

import cv2
import numpy as np
from drawn import CAMERA, RED, SURE, draw, empty, painted, segmented, standing
from drawn import MODEL as OF_CAN

from naod.config import SegmentationConfig
from naod.finding.find import find_object, likeliest
from naod.finding.groups import NO_COLOURS, groups_of
from naod.finding.hue import Colours
from naod.finding.parts import EDGE_LEVELS, GROWN_PX, parts_of
from naod.finding.regions import regions_of
from naod.perception.components import AREA, BOTTOM, LEFT, RIGHT, SUM_X, SUM_Y, TOP
from naod.perception.energy import STEPS
from naod.perception.segmenter import Segmentation
from naod.pose.objects import Cylinder, Rectangle

SETTINGS = SegmentationConfig()
CROSS = cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))
DARKER = 7
"""Levels by which a can is darker than a wall of its colour behind it."""


def read_only(yuyv):
    seen = yuyv.view()
    seen.flags.writeable = False
    return seen


def patchwork(rng):
    """A mask (120, 160) with holes, and a picture (480, 640, 2) of patches and noise behind it."""
    tones = rng.integers(100, 130, (6, 8, 2))
    yuyv = np.kron(tones, np.ones((80, 80, 1), dtype=np.int64))
    yuyv = np.clip(yuyv + rng.integers(-4, 5, yuyv.shape), 0, 255).astype(np.uint8)
    mask = (cv2.GaussianBlur(rng.normal(size=(120, 160)), (0, 0), 6.0) > -0.02).astype(np.uint8)
    return mask, yuyv


def reduced(yuyv):
    """(120, 160, 3) mean Y, U, V of the pairs of pixels, by the first of each."""
    pairs = np.dstack([yuyv[:, 0::2, 0], yuyv[:, 0::2, 1], yuyv[:, 1::2, 1]])
    return pairs.reshape(120, 4, 160, 2, 3).mean(axis=(1, 3))


def even_pixels(mask, yuyv):
    inside, colours = mask > 0, reduced(yuyv)
    out = inside.copy()
    for axis in (0, 1):
        here = [slice(None), slice(None)]
        there = list(here)
        here[axis], there[axis] = slice(1, None), slice(None, -1)
        here, there = tuple(here), tuple(there)
        steps = np.linalg.norm(colours[here] - colours[there], axis=-1) > EDGE_LEVELS
        steps &= inside[here] & inside[there]
        out[here] &= ~steps
        out[there] &= ~steps
    return out.astype(np.uint8)


def test_parts_are_what_is_connected_between_edges():
    rng = np.random.default_rng(8)
    for _ in range(5):
        mask, yuyv = patchwork(rng)
        parts = parts_of(regions_of(segmented(mask)), read_only(yuyv))
        count, seeds = cv2.connectedComponents(even_pixels(mask, yuyv), connectivity=8)
        assert len(parts.table) == count - 1 > 5
        for k in range(1, count):
            own = seeds == k
            (label,) = np.unique(parts.labels[own])
            grown = parts.labels == label
            reach = own.astype(np.uint8)
            for _ in range(GROWN_PX):
                reach = cv2.dilate(reach, CROSS) & mask
            assert not (grown & (reach == 0)).any()
        # what has no part is further from all of them
        near = (seeds > 0).astype(np.uint8)
        for _ in range(GROWN_PX):
            near = cv2.dilate(near, CROSS) & mask
        assert np.array_equal(parts.labels > 0, near > 0)


def test_table_and_evidence_are_the_labels():
    mask, yuyv = patchwork(np.random.default_rng(9))
    parts = parts_of(regions_of(segmented(mask)), read_only(yuyv))
    for k, row in enumerate(parts.table, start=1):
        y, x = np.nonzero(parts.labels == k)
        seen = [len(x), x.min(), x.max(), y.min(), y.max(), x.sum(), y.sum()]
        assert row[[AREA, LEFT, RIGHT, TOP, BOTTOM, SUM_X, SUM_Y]].tolist() == seen
        assert parts.told[k - 1] == SURE * len(x)


def before_a_wall(T, wall_too=True):
    """A can, a little darker, before a wall of its very colour; without it, the wall alone."""
    can = draw(empty(), Cylinder(), T)
    mask = can.copy()
    mask[15:100, 50:140] = 1
    yuyv = painted(mask, RED)
    if wall_too:
        yuyv[..., 0][np.kron(can, np.ones((4, 4))) > 0] -= DARKER
    return segmented(mask), Colours(yuyv, OF_CAN)


def test_a_can_before_a_wall_of_its_very_colour():
    T = standing(0.02, 0.0, 0.7)
    segmentation, colours = before_a_wall(T)
    best = find_object(segmentation, Cylinder(), CAMERA, None, SETTINGS, colours=colours)
    assert np.allclose(best.blob.centre_px, CAMERA.project(T[:3, 3])[0], atol=4.0)
    # only the picture tells them apart
    assert find_object(segmentation, Cylinder(), CAMERA, None, SETTINGS) is None


def test_that_wall_alone_is_no_can():
    segmentation, colours = before_a_wall(standing(0.02, 0.0, 0.7), wall_too=False)
    assert find_object(segmentation, Cylinder(), CAMERA, None, SETTINGS, colours=colours) is None


def test_a_board_that_touches_something_a_little_like_it():
    """Together they have about a board's proportions, and are likely one: the board is likelier."""
    T = standing(0.0, 0.0, 1.2)
    board = draw(empty(), Rectangle(), T)
    rows, columns = (np.flatnonzero(board.any(axis=axis)) for axis in (1, 0))
    mask = board.copy()
    mask[rows[0] : rows[-1] + 1, columns[-1] : columns[-1] + len(columns) // 3] = 1
    differences = np.where(mask > 0, np.int32(-2 * STEPS), np.int32(SURE))
    differences[board > 0] = -6 * STEPS
    segmentation = Segmentation(mask, 0.0, 1, 4.0, (640, 480), True, differences)
    colours = Colours(painted(mask, RED), OF_CAN)
    together = likeliest(segmented(mask), Rectangle(), CAMERA, None, SETTINGS.pixels_min)
    assert together.probability > SETTINGS.presence_min
    best = find_object(segmentation, Rectangle(), CAMERA, None, SETTINGS, colours=colours)
    assert np.allclose(best.blob.centre_px, CAMERA.project(T[:3, 3])[0], atol=4.0)


def test_two_things_of_other_shades_are_no_parts_of_one():
    """Beside each other they have a can's proportions: an edge and two colours part them."""
    T = standing(0.02, 0.0, 0.7)
    can = draw(empty(), Cylinder(), T)
    rows = np.flatnonzero(can.any(axis=1))
    yuyv = painted(can, RED)
    yuyv[: 4 * int(rows.mean()), :, 0] += 40
    parts = parts_of(regions_of(segmented(can)), read_only(yuyv))
    assert len(parts.table) == 2
    whole = groups_of(parts.table, parts.told, SETTINGS.pixels_min, True, NO_COLOURS)[1]
    assert sorted(whole.tolist()) == [1, 2, 3]
    apart = groups_of(parts.table, parts.told, SETTINGS.pixels_min, True, parts.colours)[1]
    assert sorted(apart.tolist()) == [1, 2]
