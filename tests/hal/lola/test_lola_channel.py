"""What is wanted is wanted until its deadline, by the process's own clock, and no longer."""

from __future__ import annotations

import math

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hal.lola.channel import (
    LeaveWish,
    LookWish,
    RenewWish,
    StepWish,
    StopWish,
    VelocityWish,
    Wishes,
    packed,
    unpacked,
)
from hal.types import HeadAngles, PlanarMotion


def wanted(wishes: Wishes, now_ns: int):
    return wishes.wanted(now_ns, alone=False, stand=False)


def test_look_is_forgotten_at_its_deadline() -> None:
    wishes = Wishes()
    wishes.take(LookWish(0.3, -0.1, 1.5, 1000))
    head = wanted(wishes, 999).head
    assert head is not None
    assert head.target == HeadAngles(0.3, -0.1)
    assert head.speed_rad_s == 1.5
    assert wanted(wishes, 1000).head is None
    assert wanted(wishes, 0).head is None, "and does not come back"


def test_walk_ends_at_its_deadline_unless_renewed() -> None:
    wishes = Wishes()
    wishes.take(VelocityWish(0.1, 0.0, 0.2, 1000))
    wishes.take(RenewWish(2000))
    motion = wanted(wishes, 1999).motion
    assert motion is not None
    assert motion.value == PlanarMotion(0.1, 0.0, 0.2)
    assert wanted(wishes, 2000).motion is None
    wishes.take(RenewWish(9000))
    assert wanted(wishes, 2001).motion is None, "nothing is left to renew"


def test_stop_and_zero_velocity_end_a_walk_at_once() -> None:
    for end in (StopWish(), VelocityWish(0.0, 0.0, 0.0, 5000)):
        wishes = Wishes()
        wishes.take(StepWish(0.1, 0.0, 0.0, 5000))
        wishes.take(end)
        assert wanted(wishes, 0).motion is None


def test_each_new_motion_has_a_new_number() -> None:
    wishes = Wishes()
    wishes.take(StepWish(0.1, 0.0, 0.0, 5000))
    first = wanted(wishes, 0).motion
    wishes.take(StepWish(0.1, 0.0, 0.0, 5000))
    second = wanted(wishes, 0).motion
    assert first is not None
    assert second is not None
    assert second.number > first.number
    assert second.kind == "step"


def test_nobody_there_wants_nothing_but_to_leave() -> None:
    wishes = Wishes()
    wishes.take(LookWish(0.3, 0.0, 1.0, 1000))
    wishes.take(VelocityWish(0.1, 0.0, 0.0, 1000))
    wishes.take(LeaveWish())
    wishes.still()
    assert wanted(wishes, 0).head is None
    assert wanted(wishes, 0).motion is None
    assert wanted(wishes, 0).leave


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_numbers_that_are_not_finite_are_no_wish(bad: float) -> None:
    assert unpacked(packed(LookWish(bad, 0.0, 1.0, 5))) is None
    assert unpacked(packed(VelocityWish(0.0, bad, 0.0, 5))) is None


@settings(max_examples=200, deadline=None)
@given(st.binary(max_size=600))
def test_any_bytes_are_a_wish_or_none(data: bytes) -> None:
    wish = unpacked(data)
    if wish is not None:
        Wishes().take(wish)


def test_every_wish_fits_a_packet() -> None:
    for wish in (LookWish(0.1, 0.2, 3.0, 1 << 62), StepWish(0.1, 0.2, 0.3, 1 << 62), LeaveWish()):
        data = packed(wish)
        assert len(data) < 512
        assert unpacked(data) == wish
        assert msgspec.msgpack.decode(data)["type"] == wish.__struct_config__.tag
