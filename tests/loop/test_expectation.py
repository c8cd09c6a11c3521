"""Where the object is to be expected, against a robot that walks about one that stands."""

import math
from dataclasses import replace

import numpy as np
import pytest
from builders import body, walk

from hal.nao.joints import JOINT_INDEX
from hal.nao.postures import posture
from naod.geometry.transforms import inverse, planar, rot_z, transform
from naod.localisation.base_frame import T_base_camera
from naod.localisation.body_model import BodyModel
from naod.localisation.camera_motion import CameraMotion, rotation_vector
from naod.localisation.placement import Placement
from naod.loop.expectation import anchored, expected

MODEL = BodyModel("v6", "top")
UP_FACING = np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""x right, y up, z towards where the world's x comes from."""

T_WORLD_OBJECT = transform(rot_z(0.2) @ UP_FACING, (1.2, 0.1, 0.45))
SIGMA = np.diag([1e-3, 2e-3, 1e-3, 5e-3, 5e-3, 1e-2]) ** 2


def camera_in_base(yaw=0.0, pitch=0.1):
    angles = posture("StandInit").copy()
    angles[JOINT_INDEX["HeadYaw"]], angles[JOINT_INDEX["HeadPitch"]] = yaw, pitch
    return T_base_camera(MODEL.frames(angles), body().foot_load_kg)


def seen_from(base, odometry, stamp_ns=0):
    T = inverse(planar(*base)) @ T_WORLD_OBJECT
    placement = Placement(stamp_ns, T, camera_in_base(), SIGMA, np.zeros((6, 6)), 0.0)
    return anchored(placement, replaced(walk(), odometry))


def replaced(state, odometry, **others):
    return type(state)(**{**{f: getattr(state, f) for f in state.__struct_fields__},
                          "odometry": odometry, **others})  # fmt: skip


FIRST, THEN = (0.1, -0.2, 0.3), (0.4, 0.1, -0.1)
WAY = inverse(planar(*FIRST)) @ planar(*THEN)


def odometry_after(start):
    """What exact odometry says, begun anywhere."""
    T = planar(*start) @ WAY
    return (T[0, 3], T[1, 3], math.atan2(T[1, 0], T[0, 0]))


@pytest.mark.parametrize("start", [(0.0, 0.0, 0.0), (3.0, -2.0, 2.5)])
def test_exact_odometry_and_kinematics_lead_to_where_the_object_is(start):
    anchor = seen_from(FIRST, start)
    T_now = camera_in_base(yaw=0.4, pitch=-0.1)
    prior = expected(anchor, replaced(walk(), odometry_after(start)), T_now, 2_000_000_000, False)
    true = inverse(planar(*THEN) @ T_now) @ T_WORLD_OBJECT
    assert prior.T_camera_object == pytest.approx(true, abs=1e-9)
    assert prior.age_s == 2.0


def test_a_can_is_expected_to_look_at_whoever_walks_about_it():
    anchor = seen_from(FIRST, (0.0, 0.0, 0.0))
    later = replaced(walk(), odometry_after((0.0, 0.0, 0.0)))
    can, board = (expected(anchor, later, camera_in_base(), 0, turns) for turns in (True, False))
    assert can.T_camera_object[:3, (1, 3)] == pytest.approx(board.T_camera_object[:3, (1, 3)])
    z, place = can.T_camera_object[:3, 2], can.T_camera_object[:3, 3]
    axis = can.T_camera_object[:3, 1]
    assert z @ axis == pytest.approx(0.0, abs=1e-12)
    assert abs(np.linalg.det(np.stack([z, place, axis]))) == pytest.approx(0.0, abs=1e-9)
    assert z @ place < 0.0


def test_just_seen_it_is_as_sure_as_it_was():
    """Its covariance is the placement's along other axes."""
    prior = expected(seen_from(FIRST, FIRST), replaced(walk(), FIRST), camera_in_base(), 0, False)
    assert np.linalg.eigvalsh(prior.covariance) == pytest.approx(
        np.linalg.eigvalsh(SIGMA), rel=1e-6
    )


def position_sigma(prior):
    return math.sqrt(np.trace(prior.covariance[:3, :3]))


def test_time_ways_turns_and_steps_each_make_it_less_sure():
    anchor, T = seen_from(FIRST, (0.0, 0.0, 0.0)), camera_in_base()

    def sigma(odometry=(0.0, 0.0, 0.0), stamp_ns=0, **moving):
        prior = expected(anchor, replaced(walk(), odometry, **moving), T, stamp_ns, False)
        return position_sigma(prior)

    assert sigma() < sigma(stamp_ns=10**9) < sigma(stamp_ns=4 * 10**9)
    assert sigma() < sigma((0.1, 0.0, 0.0)) < sigma((0.2, 0.0, 0.0))
    assert sigma() < sigma((0.0, 0.0, 0.2)) < sigma((0.0, 0.0, 0.4))
    assert sigma() < sigma(moving=True) < sigma(moving=True, velocity=(0.1, 0.0, 0.0))


def test_a_head_that_turns_makes_it_less_sure_aside():
    anchor, T = seen_from(FIRST, FIRST), camera_in_base()
    turning = CameraMotion(np.zeros(3), np.array([0.0, 2.0, 0.0]))
    still, swung = (
        expected(anchor, replaced(walk(), FIRST), T, 0, False, motion) for motion in (None, turning)
    )
    x, _, z = still.T_camera_object[:3, 3]
    grown = np.diag(swung.covariance - still.covariance)[:3]
    assert grown == pytest.approx(np.square((0.01 * 2.0 * z, 0.0, 0.01 * 2.0 * x)), abs=1e-12)


def test_wrong_odometry_stays_within_what_is_stated():
    """A quarter of a metre with the scales and the veer that were published for a NAO."""
    anchor, T_now = seen_from(FIRST, (0.0, 0.0, 0.0)), camera_in_base()
    true = inverse(planar(*THEN) @ T_now) @ T_WORLD_OBJECT
    x, y, yaw = odometry_after((0.0, 0.0, 0.0))
    rng = np.random.default_rng(1)
    squares = []
    for _ in range(300):
        sx, sy, turn = rng.uniform(0.85, 1.2, size=3)
        said = (sx * x, sy * y, turn * yaw + 0.1 * rng.normal() * math.hypot(x, y))
        prior = expected(anchor, replaced(walk(), said), T_now, 0, False)
        gap = prior.T_camera_object[:3, 3] - true[:3, 3]
        squares.append(gap @ np.linalg.solve(prior.covariance[:3, :3], gap) / 3.0)
        R = prior.T_camera_object[:3, :3] @ true[:3, :3].T
        assert np.linalg.norm(rotation_vector(R)) < 0.3
    assert 0.05 < np.mean(squares) < 1.0
    assert np.quantile(squares, 0.99) < 3.0


def test_after_a_long_way_nothing_is_expected():
    anchor, T = seen_from(FIRST, (0.0, 0.0, 0.0)), camera_in_base()
    assert expected(anchor, replaced(walk(), (2.5, 0.0, 0.0)), T, 0, False) is None
    assert expected(anchor, replaced(walk(), (math.nan, 0.0, 0.0)), T, 0, False) is None
    assert expected(replace(anchor, covariance=SIGMA * 1e9), walk(), T, 0, False) is None
