"""Bytes to messages, on literal values."""

from __future__ import annotations

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from naod.bus.wire import CONTROL_BYTES_MAX, RefusedError, decode, encode, failure
from naod.messages import NoArguments, WalkCommand

GOOD = b'{"source":"op","seq":7,"kind":"velocity","x":0.05,"y":0,"yaw":-0.1,"ttl_ms":250}'


def test_a_command_on_the_wire() -> None:
    command = decode(GOOD, WalkCommand)
    assert command == WalkCommand(
        source="op", seq=7, kind="velocity", x=0.05, y=0.0, yaw=-0.1, ttl_ms=250
    )
    assert decode(encode(command), WalkCommand) == command


def test_absent_ttl_is_300_ms() -> None:
    assert decode(b'{"source":"op","seq":7,"kind":"stop"}', WalkCommand).ttl_ms == 300


@pytest.mark.parametrize(
    ("payload", "words"),
    [
        (b"", "malformed"),
        (b"\xff\xfe", "malformed"),
        (b'{"source":"op"', "malformed"),
        (b"[1,2]", "invalid"),
        (GOOD.replace(b'"velocity"', b'"fly"'), "kind"),
        (GOOD.replace(b'"x"', b'"z"'), "unknown field `z`"),
        (GOOD.replace(b"0.05", b"NaN"), "not finite"),
        (GOOD.replace(b"0.05", b"-Infinity"), "not finite"),
        (GOOD.replace(b"0.05", b"1e999"), "out of range"),
        (GOOD.replace(b"0.05", b'"0.05"'), "Expected `float`"),
        (GOOD.replace(b"250", b"1001"), "ttl_ms"),
        (GOOD.replace(b"250", b"0"), "ttl_ms"),
        (GOOD.replace(b":7,", b":-1,"), "seq"),
        (GOOD.replace(b'"op"', b'""'), "source"),
        (GOOD.replace(b'"op"', b'"\\u001b[31m"'), "source"),
        (b'{"source":"' + b"x" * CONTROL_BYTES_MAX + b'"}', "oversized"),
    ],
)
def test_everything_else_is_refused_with_a_reason(payload: bytes, words: str) -> None:
    with pytest.raises(RefusedError) as caught:
        decode(payload, WalkCommand)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 250


@given(st.binary(max_size=300))
def test_no_bytes_do_anything_but_decode_or_be_refused(payload: bytes) -> None:
    try:
        decode(payload, WalkCommand)
    except RefusedError:
        return


@given(st.integers(0, len(GOOD) - 1), st.integers(0, 255))
def test_no_damaged_byte_does_either(place: int, value: int) -> None:
    damaged = GOOD[:place] + bytes([value]) + GOOD[place + 1 :]
    try:
        decode(damaged, WalkCommand)
    except RefusedError:
        return


def test_arguments_where_there_are_none() -> None:
    with pytest.raises(RefusedError, match="unknown field `x`"):
        decode(b'{"x":1}', NoArguments)


def test_failure_has_code_and_message() -> None:
    told = msgspec.json.decode(failure("busy", "later"))
    assert told == {"ok": False, "error": {"code": "busy", "message": "later"}}
