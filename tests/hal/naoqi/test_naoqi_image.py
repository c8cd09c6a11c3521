"""Pictures in every form in which they have been met or can come."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hal.naoqi.image import PictureError, bytes_from, picture_from

PIXELS = bytes(range(0, 240, 15))
"""4x2 in YUV422: 16 bytes, not valid as UTF-8."""
ASCII = b"0123456789abcdef"


def answer(data: object, kind: type = list, **changed: int) -> object:
    head = {"width": 4, "height": 2, "layers": 2, "space": 9, "s": 12, "us": 345_678, **changed}
    return kind([*head.values(), data, 0, 0.49, 0.38, -0.49, -0.38])


@pytest.mark.parametrize("kind", [list, tuple])
@pytest.mark.parametrize(
    ("data", "pixels"),
    [
        (PIXELS, PIXELS),
        (bytearray(PIXELS), PIXELS),
        (repr(PIXELS), PIXELS),
        (repr(bytearray(PIXELS)), PIXELS),
        (ASCII.decode(), ASCII),
        ("é" * 8, "é".encode() * 8),
    ],
)
def test_list_or_tuple_with_bytes_bytearray_or_text(data, pixels, kind):
    picture = picture_from(answer(data, kind), 4, 2)
    assert picture is not None
    assert picture.stamp_ns == 12_345_678_000
    assert picture.yuyv.shape == (2, 4, 2)
    assert picture.yuyv.dtype == np.uint8
    assert picture.yuyv.tobytes() == pixels
    assert not picture.yuyv.flags.writeable


@given(st.binary(min_size=1, max_size=64))
def test_any_bytes_come_through_as_a_text(data):
    """qi sends undeclared bytes as UTF-8 if they are valid, else as their Python form."""
    try:
        sent = data.decode()
    except UnicodeDecodeError:
        sent = repr(data)
    assert bytes_from(sent, len(data)) == data


@pytest.mark.parametrize("nothing", [None, [], (), answer(b"", tuple, width=0, height=0)])
def test_no_picture_yet(nothing):
    assert picture_from(nothing, 4, 2) is None


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        (answer(PIXELS, width=8), "got 8x2"),
        (answer(PIXELS, space=11, layers=3), "colour space 11"),
        (answer(PIXELS[:-1]), "bytes of 15 bytes, not 16"),
        (answer("b'\\x00"), "not 16 bytes"),
        (answer("b'abc' * 9"), "not 16 bytes"),
        (answer(None), "NoneType"),
        (answer(np.zeros(16, np.uint8)), "ndarray"),
        ([1, 2], "a list of 12"),
        ("nothing", "a list of 12"),
        (["a"] * 12, "not numbers"),
    ],
)
def test_anything_else_is_one_line(wrong, told):
    with pytest.raises(PictureError, match=told) as caught:
        picture_from(wrong, 4, 2)
    assert "\n" not in str(caught.value)
