"""Something in front of a part of an edge, or close beside one."""

import numpy as np
import pytest
from raster import BOARD, CAMERA, CAN, board_pose, can_pose, coverage, encoded
from test_pictures import INSIDE, WALL

from hal.yuyv import yuyv_from_rgb
from naod.config import SegmentationConfig
from naod.perception.blob import find_blob
from naod.perception.colour_model import Region, learn
from naod.perception.segmenter import Segmenter
from naod.pose.contour import corners_px
from naod.pose.locate import locate

GREEN = (0.05, 0.30, 0.04)
SIDES = {"top": (0, 1), "right": (1, 2), "bottom": (2, 3), "left": (3, 0)}
CHI2_99 = 11.3
CASES = [(BOARD, side) for side in SIDES] + [(CAN, side) for side in ("right", "left")]


def taken(shape, T, rng, side=None, inside_px=0.0, outside_px=30.0, share=1.0):
    """A picture with a green strip along one side, from so far inside to so far outside of it."""
    light = np.full((480, 640, 3), WALL)
    covered = coverage(shape, T, samples=3)[..., None]
    light = covered * np.array(INSIDE[shape]) + (1.0 - covered) * light
    if side is not None:
        a, b = corners_px(shape, T, CAMERA)[list(SIDES[side])]
        along = (b - a) / np.linalg.norm(b - a)
        normal = np.array([along[1], -along[0]])
        rows, columns = np.mgrid[:480, :640]
        gap = (columns - a[0]) * normal[0] + (rows - a[1]) * normal[1]
        way = (columns - a[0]) * along[0] + (rows - a[1]) * along[1]
        length = np.linalg.norm(b - a)
        begin, end = -20.0, length + 20.0
        if share < 1.0:
            end = share * length
        strip = (gap > -inside_px) & (gap < outside_px) & (way > begin) & (way < end)
        light[strip] = GREEN
    levels = np.clip(encoded(light) + rng.normal(0.0, 2.0, light.shape), 0.0, 255.0)
    return yuyv_from_rgb(levels)


def looked_at(yuyv, shape, T):
    x, y = CAMERA.project(T[:3, 3][None])[0].astype(int)
    model = learn([yuyv], Region(int(x) - 4, int(y) - 4, 8, 8))
    segmenter = Segmenter(model, SegmentationConfig(), (640, 480))
    return locate(yuyv, find_blob(segmenter.segment(yuyv)), shape, CAMERA)


def pose_of(shape):
    if shape is CAN:
        return can_pose((0.02, 0.03, 0.55), 0.3, 0.05)
    return board_pose((0.05, 0.02, 1.0), 0.15, 0.25, 0.05)


def normalised(pose, T):
    gap = pose.T_camera_object[:3, 3] - T[:3, 3]
    return gap @ np.linalg.solve(pose.covariance[:3, :3], gap)


@pytest.mark.parametrize(("shape", "side"), CASES)
def test_where_a_third_of_an_edge_is_covered_the_rest_of_it_counts(shape, side):
    T = pose_of(shape)
    yuyv = taken(shape, T, np.random.default_rng(32), side, 9.0, share=0.35)
    pose = looked_at(yuyv, shape, T)
    assert pose.edges_seen == ("top", "right", "bottom", "left")
    assert normalised(pose, T) < CHI2_99
    assert np.linalg.norm(pose.T_camera_object[:3, 3] - T[:3, 3]) < 0.01 * T[2, 3]


@pytest.mark.parametrize(("shape", "side"), CASES)
def test_a_stronger_edge_close_beside_the_object_is_not_taken_for_its_own(shape, side):
    T = pose_of(shape)
    yuyv = taken(shape, T, np.random.default_rng(33), side, inside_px=-8.0)
    pose = looked_at(yuyv, shape, T)
    assert normalised(pose, T) < CHI2_99
    assert np.linalg.norm(pose.T_camera_object[:3, 3] - T[:3, 3]) < 0.005 * T[2, 3]
