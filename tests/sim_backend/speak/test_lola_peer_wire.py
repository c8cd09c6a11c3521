"""LoLA's side of the wire: its stream cut into messages, anything else refused."""

from __future__ import annotations

import math
import struct

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hal.lola.actuators import Actuators, encode_actuators
from hal.lola.layout import LOLA_JOINTS
from hal.lola.sensors import decode_sensors
from hal.nao.joints import JOINT_INDEX
from hal.types import BodyState
from sim_backend.speak.lola_sensing import sensor_message
from sim_backend.speak.lola_wire import ActuatorMessage, ActuatorStream, WireError, end_of

WHOLE = encode_actuators(Actuators(np.linspace(-0.5, 0.5, 26), np.full(26, 0.5)))


def numbers(values: list[float]) -> bytes:
    return b"".join(b"\xca" + struct.pack(">f", value) for value in values)


def test_whole_message_is_read_and_others_may_leave_fields_out() -> None:
    chest = b"\x81\xa5Chest\x93" + numbers([0.5, 0.25, 1.0])
    found = ActuatorStream().feed(WHOLE + chest)
    assert len(found) == 2
    assert found[0].Position is not None
    assert found[0].Position[LOLA_JOINTS.index("HeadYaw")] == -0.5
    assert found[0].Sonar == [False, False]
    assert found[1] == ActuatorMessage(Chest=[0.5, 0.25, 1.0])


@settings(max_examples=50, deadline=None)
@given(st.lists(st.integers(1, 900), max_size=8))
def test_stream_may_come_in_any_pieces(cuts: list[int]) -> None:
    data, stream, found = WHOLE * 3, ActuatorStream(), []
    for cut in cuts:
        found += stream.feed(data[:cut])
        data = data[cut:]
    found += stream.feed(data)
    assert len(found) == 3
    assert found[0] == found[2]


@pytest.mark.parametrize(
    "data",
    [
        b"\x93\x01\x02\x03",
        b"\x81\xa5Chest\x92" + numbers([0.5, 0.25]),
        b"\x81\xa4Nose\x01",
        b"\x81\xa5Chest\x93" + numbers([0.5, math.nan, 1.0]),
        b"\xc1",
        b"\x81\xa5Chest\xdd\xff\xff\xff\xff",
        b"\x81\xa5Sonar\x92\x01\x00",
        b"\x81\xa5\xff\xfe\xfd\xfc\xfb\x93" + numbers([0.5, 0.5, 0.5]),
    ],
    ids=["array", "short", "unknown", "nan", "never-used", "huge", "no-bool", "no-text"],
)
def test_what_is_no_actuator_message_is_refused(data: bytes) -> None:
    with pytest.raises(WireError):
        ActuatorStream().feed(data)


@settings(max_examples=300, deadline=None)
@given(st.binary(max_size=200))
def test_any_bytes_are_read_awaited_or_refused(data: bytes) -> None:
    stream = ActuatorStream()
    try:
        for message in stream.feed(data):
            assert isinstance(message, ActuatorMessage)
    except WireError:
        return


VALUES = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**63), 2**64 - 1)
    | st.floats()
    | st.text(max_size=40)
    | st.binary(max_size=40),
    lambda inner: st.lists(inner, max_size=20) | st.dictionaries(st.text(max_size=5), inner),
    max_leaves=20,
)


@settings(max_examples=50, deadline=None)
@given(VALUES, st.binary(max_size=10))
def test_end_of_any_value_is_where_an_independent_encoder_ended_it(value, more: bytes) -> None:
    data = msgspec.msgpack.encode(value)
    assert end_of(bytearray(data + more)) == len(data)
    if len(data) > 1:
        assert end_of(bytearray(data[:-1])) is None


def test_sensor_message_says_what_the_body_measured() -> None:
    angles = np.linspace(-0.25, 0.25, 26)
    angles[JOINT_INDEX["RHipYawPitch"]] = angles[JOINT_INDEX["LHipYawPitch"]]
    body = BodyState(
        5, angles, np.zeros(3), np.array([0.5, -0.25, 9.75]), np.array([0.125, -0.125]),
        np.arange(8) / 8.0, 0.75, 48.0,
    )  # fmt: skip
    data = sensor_message(body, np.array([0.25, 0.5, 1.0]), np.full(26, 0.5), button=True)
    assert len(data) == 896
    seen = decode_sensors(data)
    assert seen.angles_rad == pytest.approx(angles, abs=1e-7)
    assert seen.accel_m_s2 == pytest.approx(body.accel_m_s2)
    assert seen.gyro_rad_s == pytest.approx([0.25, 0.5, 1.0])
    assert seen.torso_roll_pitch_rad == pytest.approx(body.torso_roll_pitch_rad)
    assert seen.fsr_kg == pytest.approx(body.fsr_kg)
    assert (seen.battery, seen.temperature_c.max()) == (0.75, 48.0)
    assert seen.battery_current_a < 0.0
    assert seen.chest_button
    assert (seen.stiffness == 0.5).all()
