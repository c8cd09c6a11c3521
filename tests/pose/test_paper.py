"""The printed estimator: its bias is the predicted one, its axes are orthonormal."""

import numpy as np
import pytest
from raster import BOARD, CAMERA, CAN, board_pose, can_pose, mask_of

from naod.pose.locate import locate_mask
from naod.pose.objects import Cylinder

SODA_CAN = Cylinder(radius_m=0.033, height_m=0.122)


def error_mm(distance, looking_down=0.0):
    # rolled a little, so that an edge does not run along one column of pixels
    T = can_pose((0.0, 0.0, distance), np.radians(looking_down), 0.1)
    found = locate_mask(mask_of(SODA_CAN, T), SODA_CAN, CAMERA, "paper").T_camera_object
    return 1e3 * (found[:3, 3] - T[:3, 3])


@pytest.mark.parametrize("distance", [0.3, 0.5, 1.0])
def test_an_upright_can_seen_level_is_one_radius_too_far(distance):
    error = error_mm(distance)
    assert error[2] == pytest.approx(34.0, abs=1.0 + 5.0 * distance)
    assert np.abs(error[:2]).max() < 3.0


@pytest.mark.parametrize(("looking_down", "change"), [(20.0, -21.0), (40.0, -39.0)])
def test_looking_down_changes_the_printed_depth(looking_down, change):
    assert error_mm(0.4, looking_down)[2] - error_mm(0.4)[2] == pytest.approx(change, abs=3.0)


def test_a_board_keeps_its_turn_but_not_its_depth():
    T = board_pose((0.0, 0.0, 0.9), 0.0, 0.5)
    pose = locate_mask(mask_of(BOARD, T), BOARD, CAMERA, "paper")
    found = pose.T_camera_object
    assert pose.estimator == "paper"
    assert np.allclose(found[:3, :3] @ found[:3, :3].T, np.eye(3), atol=1e-12)
    assert np.degrees(np.arccos(found[:3, 2] @ T[:3, 2])) < 3.0
    assert np.linalg.norm(found[:3, 3] - T[:3, 3]) < 0.02
    assert CAN != BOARD
