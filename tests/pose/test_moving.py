"""Objects that move through the picture while it is taken."""

import numpy as np
import pytest
from raster import BOARD, CAMERA, CAN, board_pose, can_pose, coverage, picture

from hal.yuyv import yuyv_from_rgb
from naod.perception.blob import blob_of_mask
from naod.pose.locate import locate, unsteady_px

RED, YELLOW, WALL = (0.55, 0.02, 0.03), (0.65, 0.45, 0.01), (0.45, 0.44, 0.40)
CASES = [
    (CAN, can_pose((0.0, 0.02, 0.8), 0.2, 0.05)),
    (BOARD, board_pose((0.0, 0.0, 1.4), 0.1, 0.3)),
]
MOTIONS = [(16.0, -10.0), (-15.0, -12.0), (18.0, 0.0), (0.0, 14.0)]
MOMENTS = 12


def moved(T, motion_px, moment):
    """Seen so many pixels further on, at a moment of -0.5 to 0.5."""
    out = T.copy()
    out[:2, 3] += moment * np.array(motion_px) / (CAMERA.fx, CAMERA.fy) * T[2, 3]
    return out


def taken(shape, T, motion_px, rng):
    """The picture and how much of each pixel and of the time the object covers."""
    moments = (np.arange(MOMENTS) + 0.5) / MOMENTS - 0.5
    covered = np.mean([coverage(shape, moved(T, motion_px, m), samples=2) for m in moments], axis=0)
    colour = RED if shape is CAN else YELLOW
    return yuyv_from_rgb(picture(covered, colour, WALL, 2.0, rng)), covered


def located(shape, T, motion_px, exposure_s=0.0):
    yuyv, covered = taken(shape, T, motion_px, np.random.default_rng(5))
    blob = blob_of_mask((covered >= 0.5).astype(np.uint8))
    return locate(yuyv, blob, shape, CAMERA, exposure_s=exposure_s)


@pytest.mark.parametrize("motion_px", MOTIONS)
@pytest.mark.parametrize(("shape", "T"), CASES)
def test_a_smear_to_any_side_costs_a_few_thousandths_of_the_distance(shape, T, motion_px):
    pose = located(shape, T, motion_px)
    gap = pose.T_camera_object[:3, 3] - T[:3, 3]
    assert np.linalg.norm(gap) < 0.006 * T[2, 3]
    assert gap @ np.linalg.solve(pose.covariance[:3, :3], gap) < 16.0
    assert pose.blur_px == pytest.approx(np.abs(motion_px).max(), rel=0.35)


def test_a_long_exposure_makes_a_moving_thing_less_sure_and_not_a_still_one():
    shape, T = CASES[0]
    for motion_px, larger in (((14.0, 6.0), True), ((0.0, 0.0), False)):
        short, long = (located(shape, T, motion_px, time_s) for time_s in (0.0, 0.033))
        ratio = long.sigma_m[0] / short.sigma_m[0]
        assert (ratio > 1.2) == larger
        assert ratio > 0.95


def test_how_unsteady_a_turn_is_grows_with_the_square_of_the_time():
    # 5 rad/s2: a head's sine of 14 degrees, 0.7 a second, seen from its turning point
    turn = np.radians(14.0) * np.cos(2.0 * np.pi * 0.7 * np.linspace(-0.0165, 0.0165, 2001))
    mean_px = CAMERA.fx * (turn[1000] - turn.mean())
    assert unsteady_px(CAMERA, 0.033) == pytest.approx(mean_px, rel=0.1)
    assert unsteady_px(CAMERA, 0.033) == pytest.approx(9.0 * unsteady_px(CAMERA, 0.011))
