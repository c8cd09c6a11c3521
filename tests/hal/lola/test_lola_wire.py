"""LoLA's messages, against bytes written out by hand."""

from __future__ import annotations

import re
import struct
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lola_literal import (
    ACTUATOR_FRAME,
    BATTERY,
    FIELDS,
    POSITION,
    ROBOT_CONFIG,
    SENSOR_FRAME,
    SENSOR_FRAME_REVERSED,
    STATUS,
    number,
    with_bytes,
)

from hal.lola.actuators import Actuators, Lights, encode_actuators
from hal.lola.layout import LOLA_JOINTS, TOUCH
from hal.lola.sensors import MessageError, decode_sensors
from hal.nao.joints import JOINT_INDEX

FACTS = Path(__file__).parents[3] / ".." / "shared" / "nao" / "lola_protocol.yaml"


def literal_angles() -> np.ndarray:
    """The positions of the literal frames, by the joints' names."""
    angles = np.zeros(26)
    for name, value in {
        "HeadYaw": 0.5,
        "HeadPitch": 0.25,
        "LShoulderPitch": 1.5,
        "LHipYawPitch": -0.375,
        "RHipYawPitch": -0.375,
        "LHipPitch": -0.5,
        "LKneePitch": 0.75,
        "RKneePitch": 0.125,
        "LHand": 1.0,
        "RHand": 0.25,
    }.items():
        angles[JOINT_INDEX[name]] = value
    return angles


def test_literal_frames_are_as_long_as_published() -> None:
    assert len(SENSOR_FRAME) == 896
    assert len(ACTUATOR_FRAME) == 786


@pytest.mark.parametrize("frame", [SENSOR_FRAME, SENSOR_FRAME_REVERSED])
def test_sensor_frame_is_read_in_any_order_of_its_keys(frame: bytes) -> None:
    seen = decode_sensors(frame)
    assert seen.angles_rad == pytest.approx(literal_angles(), abs=0.0)
    assert seen.stiffness[JOINT_INDEX["HeadYaw"]] == 0.5
    assert seen.stiffness[JOINT_INDEX["RHand"]] == -1.0
    assert seen.temperature_c[JOINT_INDEX["LKneePitch"]] == 45.5
    assert seen.temperature_c.max() == 45.5
    assert seen.current_a[JOINT_INDEX["RHand"]] == 0.125
    assert seen.status[JOINT_INDEX["LKneePitch"]] == 2.0
    assert seen.status.sum() == 2.0
    assert (seen.battery, seen.battery_current_a, seen.battery_temperature_c) == (0.75, -1.0, 38.0)
    assert seen.accel_m_s2 == pytest.approx([-0.25, 0.5, 9.75], abs=0.0)
    assert seen.gyro_rad_s == pytest.approx([0.125, 0.25, -0.375], abs=0.0)
    assert seen.torso_roll_pitch_rad == pytest.approx([0.125, -0.5], abs=0.0)
    assert seen.sonar_m == pytest.approx([1.5, 2.0], abs=0.0)
    assert seen.fsr_kg == pytest.approx([0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 0.125, 0.0], abs=0.0)
    assert seen.chest_button
    assert not seen.bumper
    assert (seen.body_id, seen.version) == ("P0000073A07S94700012", "6.0.0")


def test_status_may_come_as_floats() -> None:
    """One published parser reads them so; such a message is longer, so this one is shorter."""
    status = b"\xa6Status\xdc\x00\x19" + (number(0.0) * 10 + number(2.0) + number(0.0) * 14)
    with pytest.raises(MessageError, match="896 bytes, not 996"):
        decode_sensors(b"\x8d" + b"".join(status if f is STATUS else f for f in FIELDS))


def test_actuator_frame_is_exact() -> None:
    stiffness = np.full(26, 0.5)
    stiffness[JOINT_INDEX["RHand"]] = -1.0
    half = np.full(10, 0.5)
    lights = Lights(chest=np.array([0.25, 0.5, 1.0]), left_ear=half, right_ear=half)
    assert encode_actuators(Actuators(literal_angles(), stiffness, lights)) == ACTUATOR_FRAME


def test_sonar_is_switched_on_by_booleans() -> None:
    made = encode_actuators(Actuators(np.zeros(26), np.zeros(26)), sonar=True)
    assert made.endswith(b"\xa5Sonar\x92\xc3\xc3")
    assert len(made) == 786


@pytest.mark.parametrize("length", [0, 1, 400, 895, 897, 1792])
def test_truncated_or_doubled_frame_is_refused_with_its_length(length: int) -> None:
    with pytest.raises(MessageError, match=f"896 bytes, not {length}"):
        decode_sensors((SENSOR_FRAME * 2)[:length])


@pytest.mark.parametrize(
    "bits",
    [b"\x7f\xc0\x00\x00", b"\x7f\x80\x00\x00", b"\xff\x80\x00\x00"],
    ids=["nan", "inf", "-inf"],
)
@pytest.mark.parametrize("field", [POSITION, BATTERY])
def test_number_that_is_not_finite_is_refused(field: bytes, bits: bytes) -> None:
    spoilt = field[:-4] + bits
    with pytest.raises(MessageError, match="not finite"):
        decode_sensors(with_bytes(SENSOR_FRAME, field, spoilt))


@pytest.mark.parametrize(
    ("at", "instead"),
    [
        (b"\xa8Position", b"\xa8Positron"),
        (b"\xa5Touch\x9e", b"\xa5Touch\x9d"),
        (b"\x8d", b"\x8c"),
        (ROBOT_CONFIG[:12], b"\xabRobotConfyg"),
        (b"\xa56.0.0", b"\xa5\xff.0.0"),
    ],
)
def test_message_of_the_right_length_and_the_wrong_kind_is_refused(
    at: bytes, instead: bytes
) -> None:
    with pytest.raises(MessageError):
        decode_sensors(with_bytes(SENSOR_FRAME, at, instead))


@settings(max_examples=300, deadline=None)
@given(st.integers(0, 895), st.binary(min_size=1, max_size=40))
def test_fuzzed_frame_is_read_or_refused_and_never_odd(at: int, noise: bytes) -> None:
    frame = (SENSOR_FRAME[:at] + noise + SENSOR_FRAME[at + len(noise) :])[:896]
    try:
        seen = decode_sensors(frame)
    except MessageError:
        return
    assert np.isfinite(seen.angles_rad).all()
    assert np.isfinite(seen.fsr_kg).all()
    assert seen.angles_rad.shape == (26,)


@settings(max_examples=100, deadline=None)
@given(st.lists(st.floats(-4.0, 4.0, width=32), min_size=26, max_size=26))
def test_joint_numbers_lie_where_the_order_has_them(values: list[float]) -> None:
    """Read back by struct alone: five bytes a number, after the 12 of key and length."""
    made = encode_actuators(Actuators(np.array(values), np.zeros(26)))
    for i, name in enumerate(LOLA_JOINTS):
        (got,) = struct.unpack_from(">f", made, 1 + 12 + 5 * i + 1)
        assert got == values[JOINT_INDEX[name]]


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_actuator_values_that_are_not_finite_never_leave(bad: float) -> None:
    angles = np.zeros(26)
    angles[3] = bad
    with pytest.raises(ValueError, match="not finite"):
        encode_actuators(Actuators(angles, np.zeros(26)))


def test_short_arrays_never_leave() -> None:
    with pytest.raises(ValueError, match="26 joints"):
        encode_actuators(Actuators(np.zeros(25), np.zeros(26)))


def test_orders_are_the_published_ones() -> None:
    if not FACTS.exists():
        pytest.skip("the published facts are not beside this repository")
    text = FACTS.read_text()
    joints = re.search(r"^joint_order: \[(.*)\]$", text, re.MULTILINE)
    touch = re.search(r"Touch: .*order: \[(ChestBoard_Button[^\]]*)\]", text)
    assert joints is not None
    assert touch is not None
    assert tuple(joints[1].split(", ")) == LOLA_JOINTS
    assert tuple(touch[1].split(", ")) == TOUCH
