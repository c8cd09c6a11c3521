"""The base frame between the feet."""

import math

import numpy as np
import pytest

from hal.nao.joints import JOINT_INDEX
from hal.nao.postures import posture
from naod.geometry.transforms import inverse, rot_y, rot_z, transform, yaw_of
from naod.localisation.base_frame import T_base_camera, T_torso_base, is_lifted
from naod.localisation.body_model import BodyFrames, BodyModel

BOTH = (2.6, 2.6)


def feet(left, right):
    return BodyFrames(np.eye(4), left, right)


def test_midway_between_soles_and_along_their_mean_direction():
    left = transform(rot_z(0.2), (0.03, 0.06, -0.3))
    right = transform(rot_z(-0.1), (-0.01, -0.05, -0.3))
    T = T_torso_base(feet(left, right), BOTH)
    assert T[:3, 3] == pytest.approx((0.01, 0.005, -0.3))
    assert yaw_of(T) == pytest.approx(0.05)
    assert T[:3, 2] == pytest.approx((0, 0, 1))


def test_a_swinging_foot_does_not_lift_the_ground():
    left = transform(np.eye(3), (0.0, 0.05, -0.3))
    right = transform(rot_y(0.3), (0.04, -0.05, -0.27))
    T = T_torso_base(feet(left, right), (5.2, 0.1))
    assert T[2, 3] == pytest.approx(-0.3)
    assert T[:3, 2] == pytest.approx((0, 0, 1))
    assert T[0, 3] == pytest.approx(0.02)


def test_is_invariant_to_where_the_torso_is():
    """Moving both soles rigidly moves the base with them."""
    rng = np.random.default_rng(3)
    left = transform(rot_z(0.3), (0.05, 0.05, -0.3))
    right = transform(rot_z(0.1), (0.0, -0.05, -0.3))
    before = T_torso_base(feet(left, right), BOTH)
    for _ in range(10):
        R, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        M = transform(R * np.sign(np.linalg.det(R)), tuple(rng.normal(size=3)))
        after = T_torso_base(feet(M @ left, M @ right), BOTH)
        assert after == pytest.approx(M @ before, abs=1e-12)


def test_camera_height_at_stand_init():
    """`nao_cameras.yaml`: 0.504 m above the floor for the top camera, 0.459 for the bottom."""
    for name, height in (("top", 0.504), ("bottom", 0.459)):
        T = T_base_camera(BodyModel("v6", name).frames(posture("StandInit")), BOTH)
        assert T[2, 3] == pytest.approx(height, abs=5e-4)


def test_turning_the_head_moves_the_camera_about_the_neck():
    model = BodyModel("v6")
    angles = posture("StandInit")
    straight = T_base_camera(model.frames(angles), BOTH)
    angles[JOINT_INDEX["HeadYaw"]] = math.pi / 2
    left = T_base_camera(model.frames(angles), BOTH)
    forward = inverse(straight) @ left
    assert left[1, 3] == pytest.approx(0.05871 * 1.0, abs=1e-3)
    assert forward[0, 2] == pytest.approx(-1.0, abs=0.01)


def test_lifted_when_the_feet_bear_nothing():
    assert is_lifted((0.1, 0.2))
    assert not is_lifted(BOTH)
