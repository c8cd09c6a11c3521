"""The robot's figures hold together."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hal.backends import OpenOptions, open_robot
from hal.errors import BackendError, MotionRefusedError
from hal.nao.cameras import nominal_pinhole
from hal.nao.head_limits import YAW_MAX_RAD, clip_head, pitch_range_rad
from hal.nao.joints import JOINT_INDEX, JOINT_NAMES, LOWER_RAD, UPPER_RAD
from hal.nao.postures import POSTURE_NAMES, posture
from hal.types import HeadAngles

ANGLE = st.floats(-10, 10)


def test_every_posture_lies_within_the_limits():
    for name in POSTURE_NAMES:
        angles = posture(name)
        outside = (angles < LOWER_RAD - 2e-3) | (angles > UPPER_RAD + 2e-3)
        assert not outside.any(), (name, [JOINT_NAMES[i] for i in np.flatnonzero(outside)])


@given(yaw=ANGLE, pitch=ANGLE)
def test_clipped_head_angles_are_allowed_and_stay_when_clipped_again(yaw, pitch):
    clipped = clip_head(HeadAngles(yaw, pitch))
    low, high = pitch_range_rad(clipped.yaw_rad)
    assert abs(clipped.yaw_rad) <= YAW_MAX_RAD
    assert low <= clipped.pitch_rad <= high
    assert clip_head(clipped) == clipped


def test_pitch_range_at_published_rows_and_between():
    assert pitch_range_rad(0.0)[1] == pytest.approx(0.514872)
    assert pitch_range_rad(1.526988) == pytest.approx((-0.330041, 0.200015))
    assert pitch_range_rad(-1.526988) == pitch_range_rad(1.526988)
    middle = 0.5 * (0.756077 + 0.903033)
    assert pitch_range_rad(middle)[1] == pytest.approx(0.5 * (0.37001 + 0.330041))


@pytest.mark.parametrize("odd", [math.nan, math.inf, -math.inf])
def test_head_angles_that_are_no_numbers_are_refused(odd):
    with pytest.raises(MotionRefusedError, match="finite"):
        clip_head(HeadAngles(odd, 0.0))
    with pytest.raises(MotionRefusedError, match="finite"):
        clip_head(HeadAngles(0.0, odd))


def test_focal_lengths_agree_with_the_published_table():
    assert nominal_pinhole("v5", 640, 480).fx == pytest.approx(544.3, abs=0.05)
    assert nominal_pinhole("v6", 640, 480).fx == pytest.approx(598.1, abs=0.06)
    assert nominal_pinhole("v6", 320, 240).fx == pytest.approx(299.0, abs=0.06)


def test_left_and_right_joints_mirror_each_other():
    for name in ("HipPitch", "KneePitch", "HipYawPitch"):
        left, right = JOINT_INDEX[f"L{name}"], JOINT_INDEX[f"R{name}"]
        assert LOWER_RAD[left] == pytest.approx(LOWER_RAD[right], abs=0.011)


def test_an_unknown_backend_is_named():
    with pytest.raises(BackendError, match="'webots'"):
        open_robot("webots", OpenOptions())
