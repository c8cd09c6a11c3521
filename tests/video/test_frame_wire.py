"""The frame socket's bytes on literal values, and whatever else may come."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hal.types import Frame
from hal.video.wire import HEADER, WireError, frame_of, packed, this_clock, unpacked

PICTURE = np.arange(16, dtype=np.uint8).reshape(2, 4, 2)
FRAME = Frame(1_000_000_007, PICTURE, "bottom", 0.01, 258)
CLOCK = bytes(range(16))
LITERAL = bytes.fromhex(
    "4e414f46" "01" "01" "0400" "0200" "0000" "10000000"
    "07ca9a3b00000000" "08ca9a3b00000000" "8096980000000000" "0201000000000000"
    "000102030405060708090a0b0c0d0e0f"
)  # fmt: skip


def test_header_is_these_bytes():
    assert packed(FRAME, 1_000_000_008, CLOCK) == LITERAL
    assert len(LITERAL) == 64


def test_header_is_read_back():
    header = unpacked(LITERAL)
    assert (header.camera, header.width, header.height, header.length) == ("bottom", 4, 2, 16)
    frame = frame_of(header, PICTURE.tobytes(), 1000)
    assert frame.stamp_ns == 1_000_001_007
    assert frame.exposure_s == 0.01
    assert frame.sequence == 258
    assert np.array_equal(frame.yuyv, PICTURE)
    assert not frame.yuyv.flags.writeable


@pytest.mark.parametrize(
    ("offset", "value", "fault"),
    [
        (0, b"HTTP", "magic"),
        (4, b"\x02", "version"),
        (5, b"\x02", "camera"),
        (6, b"\x00\x00", "size"),
        (6, b"\x03\x00", "size"),
        (6, b"\xff\xff", "size"),
        (8, b"\x00\x00", "size"),
        (12, b"\xff\xff\xff\xff", "length"),
        (12, b"\x00\x00\x00\x00", "length"),
        (16, b"\xff" * 8, "time"),
        (24, bytes(8), "time"),
        (32, b"\xff" * 8, "time"),
    ],
)
def test_an_odd_header_is_refused_by_the_field_that_is_odd(offset, value, fault):
    data = bytearray(LITERAL)
    data[offset : offset + len(value)] = value
    with pytest.raises(WireError) as caught:
        unpacked(bytes(data))
    assert caught.value.fault == fault


@given(st.binary(min_size=64, max_size=64), st.integers(0, 64))
def test_any_bytes_are_a_header_or_an_error(noise, kept):
    data = LITERAL[:kept] + noise[kept:]
    try:
        header = unpacked(data)
    except WireError:
        return
    assert HEADER.pack(*HEADER.unpack(data)) == data
    assert header.length == 2 * header.width * header.height <= 2 * 4096 * 4096


def test_a_frame_of_odd_width_is_not_sent():
    odd = Frame(0, np.zeros((2, 3, 2), dtype=np.uint8), "top", 0.0, 0)
    with pytest.raises(WireError):
        packed(odd, 0, CLOCK)


def test_our_clock_has_a_name_that_stays():
    assert this_clock() == this_clock()
    assert len(this_clock()) == 16
