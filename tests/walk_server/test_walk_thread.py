"""The thread around the arbiter, on a real bus without a socket and the least of a robot."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from least_robot import PATIENCE_S, ZERO, Set

from hal.errors import HalError
from hal.types import HeadAngles, PlanarMotion
from naod.errors import InputError
from naod.messages import HeadCommand, WalkCommand
from naod.walk_server.latch import EstopLatch


@pytest.fixture
def set_up(tmp_path: Path) -> Iterator[Set]:
    parts = Set(tmp_path)
    yield parts
    parts.close()


def test_first_call_to_the_robot_is_stop(set_up: Set) -> None:
    assert set_up.robot.walk.calls[0] == "stop"


def test_velocity_over_the_bus_moves_and_ends_with_its_ttl(set_up: Set) -> None:
    set_up.send("velocity", x=0.08, ttl_ms=200)
    moving = set_up.wait_for(lambda s: s.moving)
    assert moving.velocity == (0.08, 0.0, 0.0)
    assert moving.held_by == "op"
    assert moving.last_source == "op"
    still = set_up.wait_for(lambda s: not s.moving)
    # 0.3 s after its ttl at the latest
    assert still.stamp_ns - moving.stamp_ns < 0.5e9
    set_up.wait_for(lambda s: s.held_by is None)


def test_state_comes_at_least_ten_times_a_second(set_up: Set) -> None:
    first = set_up.wait_for(lambda s: True)
    last = set_up.wait_for(lambda s: s.seq >= first.seq + 10)
    assert (last.stamp_ns - first.stamp_ns) / 1e9 < 1.0


@pytest.mark.parametrize(
    ("payload", "reason"),
    [
        (b"{", "malformed"),
        (b'{"source":"op","seq":1,"kind":"velocity","x":NaN}', "not finite"),
        (b'{"source":"op","seq":1,"kind":"velocity","x":99}', "out of range"),
        (b'{"source":"op","seq":1,"kind":"fly"}', "invalid"),
        (b'{"source":"op","seq":1,"kind":"velocity","x":0.1,"speed":1}', "unknown"),
        (b"x" * 5000, "oversized"),
    ],
)
def test_bad_messages_are_refused_counted_and_move_nothing(
    set_up: Set, payload: bytes, reason: str
) -> None:
    set_up.bus.session.put(set_up.bus.key("walk/command"), payload)
    state = set_up.wait_for(lambda s: s.refused is not None)
    assert reason in (state.refused or "")
    assert set_up.server.refusals == 1
    assert set(set_up.robot.walk.calls) == {"stop"}


def test_estop_survives_a_restart_and_release_does_not_move(tmp_path: Path) -> None:
    before = Set(tmp_path)
    before.send("velocity", x=0.1, ttl_ms=1000)
    before.wait_for(lambda s: s.moving)
    before.server.estop()
    assert before.robot.walk.status().velocity == ZERO
    before.close()

    after = Set(tmp_path)
    try:
        assert after.server.estopped
        after.send("velocity", x=0.1)
        refused = after.wait_for(lambda s: s.refused is not None).refused
        assert "estop is latched" in (refused or "")
        after.server.release()
        assert set(after.robot.walk.calls) == {"stop"}
        assert not EstopLatch(tmp_path).is_set()
    finally:
        after.close()


def test_estop_holds_even_if_it_cannot_be_kept(tmp_path: Path) -> None:
    place = tmp_path / "file"
    place.write_text("in the way")
    parts = Set(place)
    try:
        with pytest.raises(InputError, match="cannot write"):
            parts.server.estop()
        assert parts.server.estopped
    finally:
        parts.close()


def test_verdict_of_a_command_given_by_call(set_up: Set) -> None:
    good = WalkCommand(source="op", seq=1, kind="velocity", x=0.05)
    assert set_up.server.command(good) is None
    assert "replayed" in (set_up.server.command(good) or "")


def test_trackers_step_stops_without_its_heartbeat(set_up: Set) -> None:
    set_up.send("step", source="tracker", x=0.2, ttl_ms=1000)
    begin = set_up.wait_for(lambda s: s.moving)
    end = set_up.wait_for(lambda s: not s.moving)
    assert 0.3e9 < end.stamp_ns - begin.stamp_ns < 0.8e9


def test_robot_that_refuses_is_heard(set_up: Set) -> None:
    walk = set_up.robot.walk
    real = walk.set_velocity

    def refuse(velocity: PlanarMotion, valid_for_s: float) -> PlanarMotion:
        raise HalError("stiffness is off")

    walk.set_velocity = refuse  # type: ignore[method-assign]
    set_up.send("velocity", x=0.05)
    state = set_up.wait_for(lambda s: s.refused is not None)
    assert "stiffness is off" in (state.refused or "")
    walk.set_velocity = real  # type: ignore[method-assign]
    set_up.send("velocity", x=0.05)
    set_up.wait_for(lambda s: s.moving)


def test_fall_is_told_as_an_event(set_up: Set) -> None:
    heard: list[bytes] = []
    came = threading.Event()

    def listen(sample) -> None:
        heard.append(sample.payload.to_bytes())
        came.set()

    subscriber = set_up.bus.session.declare_subscriber(set_up.bus.key("event"), listen)
    set_up.robot.walk.fallen = True
    assert came.wait(PATIENCE_S)
    assert json.loads(heard[0])["kind"] == "fallen"
    set_up.send("step", x=0.1)
    assert "fallen" in (set_up.wait_for(lambda s: s.refused is not None).refused or "")
    subscriber.undeclare()


def test_thread_ends_and_says_so_when_the_robot_is_lost(tmp_path: Path) -> None:
    parts = Set(tmp_path)
    ended = threading.Event()
    parts.server.on_end = ended.set
    raised: list[threading.ExceptHookArgs] = []
    previous, threading.excepthook = threading.excepthook, raised.append
    try:
        parts.robot.walk.broken = "connection lost"
        assert ended.wait(PATIENCE_S)
        parts.server.close()
    finally:
        threading.excepthook = previous
        parts.close()
    assert "connection lost" in str(raised[0].exc_value)


def test_flood_does_not_grow_and_the_newest_wins(set_up: Set) -> None:
    for _ in range(500):
        set_up.send("velocity", x=0.01)
    set_up.send("velocity", x=0.09)
    state = set_up.wait_for(lambda s: s.velocity[0] == 0.09)
    assert state.held_by == "op"


def test_head_is_the_operators_while_its_ttl_lasts(set_up: Set) -> None:
    desk, head = set_up.server.head, set_up.robot.head
    desk.operate(HeadCommand(source="op", seq=1, yaw=0.5, pitch=0.1, ttl_ms=1000))
    assert desk.track(HeadAngles(-0.5, 0.0), 1.0) is None
    assert head.told == [HeadAngles(0.5, 0.1)]


def test_head_over_the_bus_and_its_refusals(set_up: Set) -> None:
    key = set_up.bus.key("head/command")
    set_up.bus.session.put(key, b'{"source":"op","seq":1,"yaw":9.0,"pitch":0}')
    state = set_up.wait_for(lambda s: s.refused is not None)
    assert "yaw = 9 is out of range" in (state.refused or "")
    assert set_up.robot.head.told == []


def test_head_stays_while_the_estop_is_latched(set_up: Set) -> None:
    set_up.server.estop()
    assert set_up.server.head.track(HeadAngles(0.1, 0.0), 1.0) is None
    assert set_up.robot.head.told == []
