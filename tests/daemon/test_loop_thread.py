"""The loop's thread on the simulated robot: what it does when a tick goes wrong."""

from __future__ import annotations

import gc
import queue
import threading
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TypeVar

import msgspec
import pytest

import naod.daemon.loop as loop_module
from hal.backends import OpenOptions, open_robot
from hal.errors import HalError
from naod.approach.goal import Goal
from naod.bus.bus import Bus
from naod.bus.session import open_server
from naod.config import BusConfig, DaemonConfig
from naod.daemon.act import Actor
from naod.daemon.desk import Desk
from naod.daemon.faults import Faults
from naod.daemon.loop import Loop
from naod.daemon.store import Store
from naod.daemon.warm_up import warm_up
from naod.loop.core import step
from naod.loop.equipment import Equipment
from naod.loop.state import LoopState
from naod.loop.types import Commands, Reply, Stop, Teach
from naod.messages import EventMessage, Message, StateMessage, TargetMessage, WalkCommand
from naod.pose.objects import Cylinder
from naod.walk_server.rules import Rules
from naod.walk_server.server import WalkServer

PATIENCE_S = 10.0
WATCHDOG_S = 2.0
"""As in deploy/naod.service."""
M = TypeVar("M", bound=Message)


class Heard:
    """Messages under one name."""

    def __init__(self, bus: Bus, name: str, kind: type[M]) -> None:
        self._queue: queue.SimpleQueue = queue.SimpleQueue()
        bus.subscribe(name, kind, self._queue.put, pytest.fail)

    def empty(self) -> bool:
        return self._queue.empty()

    def until(self, what: Callable[[Message], bool]) -> Message:
        while not what(message := self._queue.get(timeout=PATIENCE_S)):
            pass
        return message


class Parts:
    """Everything around a loop, on a robot in real time."""

    def __init__(self, folder: Path) -> None:
        section = {"scenario": None, "scenario_folder": folder, "seed": 0, "real_time": True}
        self.robot = open_robot("sim", OpenOptions(width=320, height=240, section=section))
        self.bus = Bus(open_server(BusConfig(listen=())), "nao")
        store = Store(folder)
        self.server = WalkServer(self.robot, self.bus, Rules(), store.latch)
        self.server.start()
        self.desk, self.faults, self.store = Desk(), Faults(), store
        self.actor = Actor(self.bus, self.server.head, store, self.desk, self.faults)
        equipment = Equipment.from_config(small_pictures(), self.robot.info, Cylinder())
        self.loop = Loop(
            self.robot, self.bus, self.server, self.actor, self.desk, equipment,
            LoopState.initial({}, None),
        )  # fmt: skip
        self.loop.before_first = partial(warm_up, equipment, self.robot)
        self.states = Heard(self.bus, "state", StateMessage)
        self.events = Heard(self.bus, "event", EventMessage)
        self.walks = Heard(self.bus, "walk/command", WalkCommand)

    def close(self) -> None:
        self.server.close()
        self.loop.close()
        self.bus.close()
        self.robot.close()


def small_pictures() -> DaemonConfig:
    config = DaemonConfig()
    camera = msgspec.structs.replace(config.camera, width=320, height=240)
    return msgspec.structs.replace(config, camera=camera)


@pytest.fixture
def parts(tmp_path: Path) -> Iterator[Parts]:
    opened = Parts(tmp_path)
    yield opened
    opened.close()
    gc.enable()
    gc.unfreeze()


def test_state_is_published_and_pictures_are_taken_once(
    parts: Parts, monkeypatch: pytest.MonkeyPatch
) -> None:
    taken: list[int] = []

    def noting(equipment, state, seen, now_ns):
        if seen.frame is not None:
            taken.append(seen.frame.sequence)
        return step(equipment, state, seen, now_ns)

    monkeypatch.setattr(loop_module, "step", noting)
    parts.loop.start()
    first = parts.states.until(lambda _s: True)
    last = parts.states.until(lambda s: s.seq >= first.seq + 20)
    assert (last.stamp_ns - first.stamp_ns) / 20 < 0.2e9
    assert last.mode == "idle"
    assert last.faults == ()
    assert len(taken) > 3
    assert sorted(set(taken)) == taken


def test_step_that_fails_is_shown_and_stops_the_robot_and_is_not_the_end(
    parts: Parts, monkeypatch: pytest.MonkeyPatch
) -> None:
    broken = threading.Event()

    def fragile(equipment, state, seen, now_ns):
        if broken.is_set():
            raise ZeroDivisionError("a defect")
        return step(equipment, state, seen, now_ns)

    monkeypatch.setattr(loop_module, "step", fragile)
    parts.loop.start()
    parts.states.until(lambda s: s.seq > 3)
    parts.loop._state = replace(parts.loop._state, mode="track", phase="centre")
    broken.set()
    told = parts.states.until(lambda s: "step_failed" in s.faults)
    assert told.mode == "idle"
    assert parts.walks.until(lambda c: c.source == "tracker").kind == "stop"
    event = parts.events.until(lambda e: e.kind == "fault")
    assert "ZeroDivisionError: a defect" in event.message
    refused: queue.SimpleQueue[tuple[str, str]] = queue.SimpleQueue()
    parts.desk.ask(Stop(), Caller(refused), parts.robot.clock.now_ns())
    assert refused.get(timeout=PATIENCE_S)[0] == "internal"

    broken.clear()
    parts.desk.ask(Stop(), Caller(refused), parts.robot.clock.now_ns())
    assert refused.get(timeout=PATIENCE_S)[0] == "ok"
    assert parts.faults.counts["step_failed"] >= 1


class Caller:
    """Stands where somebody waits for an answer."""

    def __init__(self, answers: queue.SimpleQueue[tuple[str, str]]) -> None:
        self._answers = answers

    def ok(self, **fields: object) -> None:
        self._answers.put(("ok", ""))

    def error(self, code: str, message: str) -> None:
        self._answers.put((code, message))


def test_camera_that_fails_is_a_fault_and_the_loop_goes_on(
    parts: Parts, monkeypatch: pytest.MonkeyPatch
) -> None:
    def unplugged(max_age_s: float) -> None:
        raise HalError("no such device")

    monkeypatch.setattr(parts.robot.camera, "latest", unplugged)
    parts.loop.start()
    told = parts.states.until(lambda s: "camera_failed" in s.faults)
    parts.states.until(lambda s: s.seq > told.seq + 3 and "no_picture" in s.faults)


def test_walk_server_that_fell_silent_is_a_fault_and_feeds_no_watchdog(parts: Parts) -> None:
    fed = threading.Event()
    parts.loop.after_tick = fed.set
    parts.loop.start()
    assert fed.wait(PATIENCE_S)
    parts.server.close()
    parts.events.until(lambda e: e.kind == "fault" and "walk_silent" in e.message)
    fed.clear()
    assert not fed.wait(0.5)


def test_robot_stops_by_itself_when_the_walk_server_hangs(
    parts: Parts, monkeypatch: pytest.MonkeyPatch
) -> None:
    """S2: the deadline of the last motion is the robot's own."""
    walk, clock = parts.robot.walk, parts.robot.clock
    drive = WalkCommand(source="op", seq=1, kind="velocity", x=0.08, ttl_ms=1000)
    assert parts.server.command(drive) is None
    assert walk.status().velocity.x > 0.0
    hung = threading.Event()
    monkeypatch.setattr(parts.server, "_tick", hung.wait)
    begin_ns = now_ns = clock.now_ns()
    while walk.status().velocity.x > 0.0 and now_ns - begin_ns < 2e9:
        clock.sleep_until(now_ns + 10_000_000)
        now_ns = clock.now_ns()
    assert now_ns - begin_ns < 0.6e9
    hung.set()


def test_tick_that_takes_long_is_counted_and_stops_nobody(
    parts: Parts, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Learning a colour takes a part of a second, more on a robot: several deadlines.

    The walk is not the loop's to stop meanwhile, and the watchdog has the time for it.
    """
    long_s, fed, slow = 0.6, threading.Event(), threading.Event()
    velocities: list[float] = []

    def learning(equipment, state, seen, now_ns):
        if slow.is_set():
            slow.clear()
            threading.Event().wait(long_s)
            velocities.append(parts.robot.walk.status().velocity.x)
        return step(equipment, state, seen, now_ns)

    monkeypatch.setattr(loop_module, "step", learning)
    parts.loop.after_tick = fed.set
    parts.loop.start()
    before = parts.states.until(lambda s: s.seq > 3)
    drive = WalkCommand(source="op", seq=1, kind="velocity", x=0.08, ttl_ms=1000)
    assert parts.server.command(drive) is None
    fed.clear()
    slow.set()
    assert fed.wait(WATCHDOG_S)
    after = parts.states.until(lambda s: s.stamp_ns > before.stamp_ns + long_s * 1e9)
    assert velocities[0] > 0.0
    assert after.faults == ()
    assert parts.walks.empty()
    deadline_ns = parts.loop.now_ns() + int(PATIENCE_S * 1e9)
    while parts.loop.diagnostics is None or parts.loop.diagnostics.overruns < 5:
        parts.states.until(lambda _s: True)
        assert parts.loop.now_ns() < deadline_ns


def test_what_cannot_be_kept_is_told_to_whoever_asked(parts: Parts) -> None:
    answers: queue.SimpleQueue[tuple[str, str]] = queue.SimpleQueue()
    parts.desk.ask(Teach("cup"), Caller(answers), 0)
    (request,) = parts.desk.take()
    (parts.store.folder / "goals").write_text("in the way")
    nothing = TargetMessage(found=False, age_s=None, ego=None, sigma_m=None)
    state = StateMessage(
        seq=1, stamp_ns=0, mode="track", phase="centre", goal=None, target=nothing, error=None,
        faults=(),
    )  # fmt: skip
    goal = Goal(kind="cylinder", rho_m=0.4, theta_rad=0.0, z_m=0.4, phi_rad=3.1)
    replies = (Reply(request.ticket),)
    parts.actor.carry_out(Commands(state, replies=replies, keep_goal=("cup", goal)), 0)
    code, message = answers.get(timeout=PATIENCE_S)
    assert code == "not_kept"
    assert "goals" in message
    assert parts.states.until(lambda s: bool(s.faults)).faults == ("not_kept",)


def test_thread_that_ends_says_so(parts: Parts) -> None:
    ended = threading.Event()
    raised: list[threading.ExceptHookArgs] = []
    previous, threading.excepthook = threading.excepthook, raised.append

    def fail() -> None:
        raise RuntimeError("cannot warm up")

    parts.loop.before_first = fail
    parts.loop.on_end = ended.set
    try:
        parts.loop.start()
        assert ended.wait(PATIENCE_S)
        parts.loop.close()
    finally:
        threading.excepthook = previous
    assert "cannot warm up" in str(raised[0].exc_value)


def test_collector_is_off_while_the_loop_runs(parts: Parts) -> None:
    parts.loop.start()
    parts.states.until(lambda s: s.seq > 1)
    assert not gc.isenabled()
    assert gc.get_freeze_count() > 0
