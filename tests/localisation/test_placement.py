"""What leaning, lateness and blur do to a placement, against doing them."""

import math

import cv2
import numpy as np
import pytest

from naod.geometry.transforms import rot_x, rot_z, transform
from naod.localisation.camera_motion import CameraMotion
from naod.localisation.ego import ego_pose
from naod.localisation.placement import (
    CLOCK_JITTER_S,
    CLOCK_OFFSET_S,
    COMMON_SHARE,
    JITTER_RAD,
    LEANING_RAD,
    SHARP_PX,
    blurred,
    placed,
    turned,
)
from naod.pose.result import ObjectPose

T_BASE_CAMERA = transform(
    rot_z(0.3) @ np.array([[0.0, 0, 1], [-1, 0, 0], [0, -1, 0]]) @ rot_x(-0.1), (0.08, 0.0, 0.5)
)
T_CAMERA_OBJECT = transform(rot_x(math.pi) @ rot_z(0.2), (0.05, 0.1, 0.9))


def pose(sigma=1e-3):
    return ObjectPose(T_CAMERA_OBJECT, np.eye(6) * sigma**2, np.zeros((4, 2)), "exact")


def test_a_small_turn_moves_the_object_as_computed():
    arm, step = np.array([0.9, -0.2, 0.4]), 1e-6
    for axis in range(3):
        delta = np.zeros(3)
        delta[axis] = step
        R = cv2.Rodrigues(delta)[0]
        assert turned(arm)[:3, axis] == pytest.approx((R @ arm - arm) / step, abs=1e-5)
        assert turned(arm)[3:, axis] == pytest.approx(delta / step)


def test_own_and_shared_are_what_turning_the_body_at_random_gives():
    """Leaning about the feet and about the camera, drawn 20000 times, moves x, y, z and phi so."""
    still = placed(0, pose(sigma=0.0), T_BASE_CAMERA)
    rng = np.random.default_rng(3)
    rows = []
    for neck, feet in rng.normal(size=(20_000, 2, 3)) * LEANING_RAD:
        R = cv2.Rodrigues(neck)[0]
        T = still.T_base_object.copy()
        T[:3, 3] = T_BASE_CAMERA[:3, 3] + R @ (T[:3, 3] - T_BASE_CAMERA[:3, 3])
        T[:3, :3] = R @ T[:3, :3]
        lean = transform(cv2.Rodrigues(feet)[0], (0, 0, 0))
        ego = ego_pose(lean @ T)
        rows.append((ego.x_m, ego.y_m, ego.z_m, ego.phi_rad))
    drawn = np.cov(np.array(rows).T)
    look = still.look()
    scale = np.sqrt(np.outer(np.diag(drawn), np.diag(drawn)))
    assert look.shared / scale == pytest.approx(drawn / scale, abs=0.04)
    assert look.covariance == pytest.approx(look.shared * (JITTER_RAD / LEANING_RAD) ** 2)


def test_what_pictures_share_stays_apart():
    look = placed(0, pose(sigma=0.01), T_BASE_CAMERA).look()
    bare = placed(0, pose(sigma=0.0), T_BASE_CAMERA).look()
    assert np.diag(look.shared - bare.shared)[:3] == pytest.approx(COMMON_SHARE * 1e-4)
    assert np.diag(look.total - bare.total)[:3] == pytest.approx(1e-4)


def test_blur_adds_to_what_is_each_picture_s_own():
    sharp, smeared = (placed(0, pose(), T_BASE_CAMERA, None, px) for px in (0.0, 10.0))
    assert smeared.shared == pytest.approx(sharp.shared)
    grown = np.diag(smeared.own - sharp.own)
    assert grown == pytest.approx(1e-6 * (10.0 / SHARP_PX) ** 2)
    seen = placed(0, pose(), T_BASE_CAMERA, None, 10.0, 10.0)
    assert seen.own == pytest.approx(sharp.own)
    assert seen.blur_px == 10.0


def test_a_head_that_turns_makes_the_time_matter():
    """One radian a second, by the clock's error: a lever of the object's distance."""
    motion = CameraMotion(np.zeros(3), np.array([0.0, 1.0, 0.0]))
    still = placed(0, pose(), T_BASE_CAMERA)
    turning = placed(0, pose(), T_BASE_CAMERA, motion)
    aside = np.array([T_CAMERA_OBJECT[2, 3], 0.0, -T_CAMERA_OBJECT[0, 3]])
    lever = T_BASE_CAMERA[:3, :3] @ aside
    for name, late_s in (("own", CLOCK_JITTER_S), ("shared", CLOCK_OFFSET_S)):
        grown = (getattr(turning, name) - getattr(still, name))[:3, :3]
        assert grown == pytest.approx(late_s**2 * np.outer(lever, lever), abs=1e-12)


@pytest.mark.parametrize("edges_px", [0.0, 4.0])
def test_covariance_grows_with_the_blur_that_edges_did_not_show(edges_px):
    grown = [np.trace(blurred(np.eye(6), float(blur_px), edges_px)) for blur_px in range(0, 20, 2)]
    assert grown == sorted(grown)
    assert grown[0] == 6.0
    assert np.trace(blurred(np.eye(6), edges_px, edges_px)) == 6.0
    assert grown[-1] > 20.0 * grown[0]


def test_a_placement_that_is_no_number_is_no_look():
    spoilt = pose()
    spoilt.covariance[0, 0] = math.nan
    assert placed(0, spoilt, T_BASE_CAMERA).look() is None
