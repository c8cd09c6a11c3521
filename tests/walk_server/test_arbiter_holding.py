"""Who holds the walk, and how long a step lasts."""

from __future__ import annotations

from walk_desk import MS, RULES, STANDING, WALKING, Desk

from hal.types import PlanarMotion
from naod.walk_server.types import Halt, Heartbeat, MoveTo, Renew, SetVelocity


def test_operator_holds_the_walk_over_the_tracker_until_the_ttl() -> None:
    desk = Desk()
    assert desk.send("step", source="tracker", at_ms=0) is None
    assert isinstance(desk.tick(0), MoveTo)
    assert desk.send("velocity", source="op", at_ms=100, status=WALKING) is None
    assert desk.state.held_by == "op"
    assert isinstance(desk.tick(110, WALKING), SetVelocity)
    reason = desk.send("step", source="tracker", at_ms=200)
    assert reason is not None
    assert "op holds the walk" in reason
    desk.tick(400, WALKING)
    assert desk.state.held_by is None
    assert desk.send("step", source="tracker", at_ms=410) is None


def test_tracker_may_not_stop_what_an_operator_drives() -> None:
    desk = Desk()
    desk.send("velocity", source="op")
    desk.tick(0)
    assert desk.send("stop", source="tracker", at_ms=50) is not None
    assert isinstance(desk.tick(60, WALKING), Renew)


def test_second_operator_may_stop_but_not_drive() -> None:
    desk = Desk()
    desk.send("velocity", source="anna")
    desk.tick(0)
    reason = desk.send("velocity", source="bert", at_ms=20)
    assert reason is not None
    assert "anna holds" in reason
    assert desk.send("stop", source="bert", at_ms=40) is None
    assert desk.tick(50, WALKING) == Halt()


def test_operators_step_holds_until_the_robot_stands() -> None:
    desk = Desk()
    desk.send("step", at_ms=0, ttl_ms=100)
    desk.tick(0)
    assert isinstance(desk.tick(500, STANDING), Renew)  # its reaction time
    assert isinstance(desk.tick(1500, WALKING), Renew)
    assert desk.state.held_by == "op"
    assert desk.tick(3000, STANDING) is None
    assert desk.state.held_by is None
    assert desk.state.motion is None


def test_step_that_never_begins_lets_go() -> None:
    desk = Desk()
    desk.send("step", at_ms=0, ttl_ms=100)
    desk.tick(0)
    desk.tick(RULES.step_start_s * 1000 + 50, STANDING)
    assert desk.state.motion is None
    assert desk.state.held_by is None


def test_step_that_never_ends_is_stopped() -> None:
    desk = Desk()
    desk.send("step", at_ms=0)
    desk.tick(0)
    longest_ms = RULES.longest_step_s(PlanarMotion(0.05, 0.0, 0.0)) * 1000
    assert isinstance(desk.tick(longest_ms - 10, WALKING), Renew)
    assert desk.tick(longest_ms + 10, WALKING) == Halt()


def test_trackers_step_ends_when_the_tracker_falls_silent() -> None:
    desk = Desk()
    desk.send("step", source="tracker", at_ms=0)
    desk.tick(0)
    assert isinstance(desk.tick(490, WALKING), Renew)
    desk.give(Heartbeat(450 * MS))
    assert isinstance(desk.tick(940, WALKING), Renew)
    assert desk.tick(960, WALKING) == Halt()


def test_operators_step_needs_no_tracker() -> None:
    desk = Desk()
    desk.send("step", source="op", at_ms=0)
    desk.tick(0)
    assert isinstance(desk.tick(2000, WALKING), Renew)
