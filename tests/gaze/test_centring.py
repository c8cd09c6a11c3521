"""Where the head has to point, checked by forward kinematics."""

import math

import numpy as np
import pytest

from hal.nao.head_limits import pitch_range_rad
from hal.nao.joints import JOINT_INDEX
from hal.nao.postures import posture
from hal.types import HeadAngles
from naod.gaze.centring import head_towards, is_centred, offset_rad
from naod.gaze.search import DWELL_S, FIRST_S, PLACES, search_place
from naod.localisation.body_model import BodyModel


def angles_with(head):
    angles = posture("StandInit")
    angles[JOINT_INDEX["HeadYaw"]] = head.yaw_rad
    angles[JOINT_INDEX["HeadPitch"]] = head.pitch_rad
    return angles


@pytest.mark.parametrize("camera", ["top", "bottom"])
def test_a_far_ray_lands_in_the_middle_after_one_turn(camera):
    rng = np.random.default_rng(4)
    model = BodyModel("v6", camera)
    for _ in range(30):
        now = HeadAngles(rng.uniform(-1.0, 1.0), rng.uniform(-0.2, 0.2))
        ray = np.array([rng.uniform(-0.3, 0.3), rng.uniform(-0.15, 0.1), 1.0])
        T_before = model.frames(angles_with(now)).T_torso_camera
        wanted = head_towards(ray, T_before, now, camera, 1.0)
        T_after = model.frames(angles_with(wanted)).T_torso_camera
        seen = T_after[:3, :3].T @ T_before[:3, :3] @ ray
        low, high = pitch_range_rad(wanted.yaw_rad)
        if low + 1e-9 < wanted.pitch_rad < high - 1e-9:
            assert offset_rad(seen) < 1e-7
        else:
            assert abs(math.atan2(seen[0], seen[2])) < 0.2


def test_a_near_object_is_centred_within_three_pictures():
    """The camera sits 6 cm before the neck, so turning the head shifts it."""
    model = BodyModel("v6")
    place = np.array([0.45, 0.15, 0.2])
    head = HeadAngles(0.0, 0.0)
    for _ in range(3):
        T = model.frames(angles_with(head)).T_torso_camera
        ray = T[:3, :3].T @ (place - T[:3, 3])
        head = head_towards(ray / ray[2], T, head, "top", 1.0)
    T = model.frames(angles_with(head)).T_torso_camera
    assert offset_rad(T[:3, :3].T @ (place - T[:3, 3])) < math.radians(0.3)


def test_at_the_end_of_the_neck_it_counts_as_centred():
    now = HeadAngles(0.0, 0.515)
    assert is_centred(np.array([0.0, 0.4, 1.0]), now, HeadAngles(0.0, 0.515), 0.05)
    assert not is_centred(np.array([0.0, 0.4, 1.0]), HeadAngles(0.0, 0.3), now, 0.05)


def test_search_begins_where_it_was_last_seen_and_covers_both_sides():
    first = HeadAngles(0.4, 0.1)
    assert search_place(first, 0.0) == first
    visited = [search_place(first, FIRST_S + (i + 0.5) * DWELL_S) for i in range(len(PLACES))]
    assert set(visited) == set(PLACES)
    assert min(p.yaw_rad for p in visited) < -1.5
    assert max(p.yaw_rad for p in visited) > 1.5
