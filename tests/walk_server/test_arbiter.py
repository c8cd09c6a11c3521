"""The rules of the walk, one by one, on the pure core."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from walk_desk import FALLEN, MS, RULES, STANDING, WALKING, Desk

from hal.types import PlanarMotion
from naod.walk_server import arbiter
from naod.walk_server.types import (
    ArbiterState,
    End,
    Estop,
    Halt,
    MoveTo,
    Release,
    Renew,
    SetVelocity,
    Unreadable,
)


def test_first_act_is_to_halt() -> None:
    state, action = arbiter.tick(ArbiterState(), STANDING, 0, RULES)
    assert action == Halt()
    assert arbiter.tick(state, STANDING, 40 * MS, RULES)[1] is None


def test_velocity_is_sent_renewed_and_ends_with_its_ttl() -> None:
    desk = Desk()
    assert desk.send("velocity", at_ms=0) is None
    sent = desk.tick(10)
    assert isinstance(sent, SetVelocity)
    assert sent.velocity == PlanarMotion(0.05, 0.0, 0.0)
    assert isinstance(desk.tick(50, WALKING), Renew)
    assert isinstance(desk.tick(299, WALKING), Renew)
    assert desk.tick(300, WALKING) == Halt()
    assert desk.tick(340, STANDING) is None


def test_deadline_given_to_the_robot_reaches_little_past_the_ttl() -> None:
    """Should this process hang, the robot stops within 0.3 s of the ttl by itself."""
    desk = Desk()
    desk.send("velocity", at_ms=0, ttl_ms=300)
    desk.tick(0)
    last = desk.tick(299, WALKING)
    assert isinstance(last, Renew)
    assert 0.0 < last.valid_for_s <= 0.001 + RULES.slack_s + 1e-9


def test_renewed_velocity_goes_on() -> None:
    desk = Desk()
    for at_ms in range(0, 1000, 100):
        assert desk.send("velocity", at_ms=at_ms) is None
        assert isinstance(desk.tick(at_ms + 20, WALKING), SetVelocity)
    assert isinstance(desk.tick(1100, WALKING), Renew)
    assert desk.tick(1201, WALKING) == Halt()


def test_velocity_is_saturated_and_keeps_its_direction() -> None:
    desk = Desk()
    desk.send("velocity", motion=(3.0, 4.0, -5.0))
    sent = desk.tick(0)
    assert isinstance(sent, SetVelocity)
    assert math.hypot(sent.velocity.x, sent.velocity.y) == pytest.approx(RULES.speed_max_m_s)
    assert sent.velocity.y / sent.velocity.x == pytest.approx(4.0 / 3.0)
    assert sent.velocity.yaw == -RULES.turn_max_rad_s


def test_step_is_saturated() -> None:
    desk = Desk()
    desk.send("step", motion=(-2.0, 0.0, 3.0))
    sent = desk.tick(0)
    assert isinstance(sent, MoveTo)
    assert sent.step.x == pytest.approx(-RULES.step_max_m)
    assert sent.step.yaw == RULES.step_turn_max_rad


@pytest.mark.parametrize(
    ("motion", "word"),
    [
        ((math.nan, 0.0, 0.0), "x is not a finite"),
        ((0.0, math.inf, 0.0), "y is not a finite"),
        ((0.0, 0.0, -math.inf), "yaw is not a finite"),
        ((10.5, 0.0, 0.0), "x = 10.5 is out of range"),
        ((0.0, -11.0, 0.0), "y = -11 is out of range"),
        ((0.0, 0.0, 6.3), "yaw = 6.3 is out of range"),
    ],
)
@pytest.mark.parametrize("kind", ["velocity", "step"])
def test_impossible_numbers_are_refused(
    kind: str, motion: tuple[float, float, float], word: str
) -> None:
    desk = Desk()
    reason = desk.send(kind, motion=motion)
    assert reason is not None
    assert word in reason
    assert desk.tick(10) is None
    assert desk.state.held_by is None


def test_stop_stops_whatever_its_numbers_say() -> None:
    desk = Desk()
    desk.send("velocity")
    desk.tick(0)
    assert desk.send("stop", at_ms=20, motion=(99.0, math.nan, 0.0)) is None
    assert desk.tick(40, WALKING) == Halt()


def test_replayed_command_is_refused_even_if_the_first_was_not_obeyed() -> None:
    desk = Desk()
    assert desk.send("velocity", seq=5, status=FALLEN) is not None
    reason = desk.send("velocity", seq=5)
    assert reason is not None
    assert "replayed" in reason
    assert desk.send("velocity", seq=4) is not None
    assert desk.send("velocity", seq=6) is None


def test_sequence_numbers_are_per_source() -> None:
    desk = Desk()
    assert desk.send("stop", source="a", seq=900) is None
    assert desk.send("stop", source="b", seq=1, at_ms=400) is None


def test_sources_are_bounded_and_silent_ones_forgotten() -> None:
    desk = Desk()
    for i in range(RULES.sources_max):
        desk.send("stop", source=f"s{i}", at_ms=0, ttl_ms=1)
    reason = desk.send("stop", source="one more", at_ms=1000)
    assert reason is not None
    assert "sources" in reason
    assert desk.send("stop", source="one more", at_ms=61_000) is None
    assert len(desk.state.last) == RULES.sources_max


def test_estop_latches() -> None:
    desk = Desk()
    desk.send("velocity", at_ms=0)
    desk.tick(0)
    desk.give(Estop())
    assert desk.tick(10, WALKING) == Halt()
    reason = desk.send("velocity", at_ms=50)
    assert reason is not None
    assert "estop" in reason
    assert desk.tick(60) is None
    desk.give(Release())
    assert desk.tick(100) == Halt()  # letting go moves nothing
    assert desk.tick(140) is None
    assert desk.send("velocity", at_ms=200) is None
    assert isinstance(desk.tick(210), SetVelocity)


def test_estop_in_the_same_tick_as_a_command_wins_whatever_the_order() -> None:
    for estop_first in (True, False):
        desk = Desk()
        if estop_first:
            desk.give(Estop())
        desk.send("velocity")
        if not estop_first:
            desk.give(Estop())
        assert desk.tick(0) == Halt()
        assert desk.tick(40) is None


def test_fallen_robot_is_not_moved() -> None:
    desk = Desk()
    reason = desk.send("step", status=FALLEN)
    assert reason is not None
    assert "fallen" in reason
    assert desk.tick(0, FALLEN) is None


def test_fall_ends_the_motion_for_good() -> None:
    desk = Desk()
    desk.send("step")
    desk.tick(0)
    assert desk.tick(40, replace(WALKING, fallen=True)) == Halt()
    assert desk.tick(80, STANDING) is None


def test_motion_nobody_commanded_is_stopped() -> None:
    desk = Desk()
    assert desk.tick(40, WALKING) == Halt()


def test_end_lets_go_of_everything() -> None:
    desk = Desk()
    desk.send("velocity")
    desk.tick(0)
    desk.give(End())
    assert desk.tick(10, WALKING) == Halt()
    assert desk.state.held_by is None


def test_refusals_are_counted_and_shown_until_the_next_good_command() -> None:
    desk = Desk()
    desk.give(Unreadable("walk/command: malformed", 3))
    assert desk.state.refusals == 3
    assert arbiter.report(desk.state, STANDING, 1).refused == "walk/command: malformed"
    desk.send("stop")
    assert arbiter.report(desk.state, STANDING, 2).refused is None
    assert desk.state.refusals == 3


def test_reason_cannot_grow_without_bound() -> None:
    desk = Desk()
    desk.give(Unreadable("x" * 10_000))
    assert len(desk.state.refused or "") == 200


def test_refusal_by_the_robot_ends_the_motion() -> None:
    desk = Desk()
    desk.send("step")
    desk.tick(0)
    desk.state = arbiter.refused_by_robot(desk.state, "stiffness is off")
    assert desk.state.held_by is None
    assert "stiffness is off" in (desk.state.refused or "")
    assert desk.tick(40) == Halt()
