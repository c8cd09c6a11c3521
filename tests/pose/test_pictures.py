"""Whole way from a noisy YUYV picture to a pose: colour, segmentation, blob, edges, fit."""

import numpy as np
import pytest
from raster import BOARD, CAMERA, CAN, board_pose, can_pose, coverage, picture

from hal.yuyv import yuyv_from_rgb
from naod.config import SegmentationConfig
from naod.perception.blob import find_blob
from naod.perception.colour_model import Region, learn
from naod.perception.segmenter import Segmenter
from naod.pose.locate import locate

RED, YELLOW, WALL = (0.55, 0.02, 0.03), (0.65, 0.45, 0.01), (0.45, 0.44, 0.40)
INSIDE = {CAN: RED, BOARD: YELLOW}


def frame(shape, T, rng):
    covered = coverage(shape, T, samples=6)
    return yuyv_from_rgb(picture(covered, INSIDE[shape], WALL, 2.0, rng))


def looked_at(shape, T, rng, estimator="exact"):
    """The pose found after learning the colour from the middle of the object."""
    yuyv = frame(shape, T, rng)
    x, y = CAMERA.project(T[:3, 3][None])[0].astype(int)
    model = learn([yuyv], Region(int(x) - 4, int(y) - 4, 8, 8))
    segmenter = Segmenter(model, SegmentationConfig(), (640, 480))
    return locate(yuyv, find_blob(segmenter.segment(yuyv)), shape, CAMERA, estimator)


def cases(shape, distances, rng):
    for distance in distances:
        for _ in range(3):
            place = (*rng.uniform(-0.1, 0.1, 2) * distance, distance)
            tilt, turn = np.radians(rng.uniform(-5, 40)), np.radians(rng.uniform(-40, 40))
            roll = np.radians(rng.uniform(-10, 10))
            if shape is CAN:
                yield distance, can_pose(place, tilt, roll)
            else:
                yield distance, board_pose(place, tilt, turn, roll)


@pytest.mark.parametrize(
    ("shape", "distances"), [(CAN, (0.35, 0.7, 1.2, 2.0)), (BOARD, (0.6, 1.2, 2.0))]
)
def test_within_half_a_percent_of_the_distance_and_as_sure_as_it_says(shape, distances):
    rng = np.random.default_rng(11)
    errors, normalised = [], []
    for distance, T in cases(shape, distances, rng):
        pose = looked_at(shape, T, rng)
        gap = pose.T_camera_object[:3, 3] - T[:3, 3]
        errors.append(np.linalg.norm(gap) / distance)
        normalised.append(gap @ np.linalg.solve(pose.covariance[:3, :3], gap))
        assert pose.clipped == ()
        assert pose.T_camera_object[:3, 1] @ T[:3, 1] > np.cos(np.radians(12.0))
    assert np.median(errors) < 0.002
    assert max(errors) < 0.01
    # 99th percentile of chi squared with three degrees of freedom
    assert max(normalised) < 11.3


def test_an_object_reduced_pixels_wide_is_placed_by_its_edges():
    rng = np.random.default_rng(12)
    T = can_pose((0.05, 0.02, 1.0), 0.3)
    pose = looked_at(CAN, T, rng)
    # ten reduced pixels wide: one of them would be a tenth of the distance
    assert abs(pose.T_camera_object[2, 3] - 1.0) < 0.005
    assert pose.sigma_m[2] < 0.02


def test_the_printed_estimator_is_biased_as_predicted_on_pictures_too():
    rng = np.random.default_rng(13)
    T = can_pose((0.0, 0.0, 0.6), 0.0, 0.1)
    printed = looked_at(CAN, T, rng, "paper")
    exact = looked_at(CAN, T, rng)
    assert printed.estimator == "paper"
    assert printed.T_camera_object[2, 3] - 0.6 == pytest.approx(0.034, abs=0.004)
    assert abs(exact.T_camera_object[2, 3] - 0.6) < 0.003


def test_clipped_at_the_bottom():
    rng = np.random.default_rng(14)
    for shape, T in (
        (CAN, can_pose((0.02, 0.16, 0.5), 0.25)),
        (BOARD, board_pose((0.0, 0.27, 0.8), 0.2, 0.3)),
    ):
        pose = looked_at(shape, T, rng)
        assert pose.clipped == ("bottom",)
        assert np.linalg.norm(pose.T_camera_object[:3, 3] - T[:3, 3]) < 0.01 * T[2, 3]


def test_the_same_picture_gives_the_same_pose():
    T = can_pose((0.02, 0.0, 0.6), 0.3)
    first, second = (looked_at(CAN, T, np.random.default_rng(15)) for _ in range(2))
    assert (first.T_camera_object == second.T_camera_object).all()
    assert (first.covariance == second.covariance).all()
