"""The least of a robot, and a walk server on it, on a real bus without a socket."""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from hal.errors import HalError
from hal.types import HeadAngles, PlanarMotion, WalkStatus
from naod.bus.bus import Bus
from naod.bus.session import open_server
from naod.config import BusConfig
from naod.messages import WalkState
from naod.walk_server.latch import EstopLatch
from naod.walk_server.rules import Rules
from naod.walk_server.server import WalkServer

ZERO = PlanarMotion(0.0, 0.0, 0.0)
PATIENCE_S = 5.0


class LeastClock:
    def now_ns(self) -> int:
        return time.monotonic_ns()

    def sleep_until(self, deadline_ns: int) -> None:
        time.sleep(max(0, deadline_ns - self.now_ns()) / 1e9)


class LeastWalk:
    """Does what it is told at once, until its deadline."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._told = ZERO
        self._ends_ns = 0
        self.fallen = False
        self.broken: str | None = None
        self.calls: list[str] = []

    def _tell(self, name: str, motion: PlanarMotion, valid_for_s: float) -> PlanarMotion:
        if self.broken:
            raise HalError(self.broken)
        with self._lock:
            self.calls.append(name)
            self._told = motion
            self._ends_ns = time.monotonic_ns() + int(valid_for_s * 1e9)
        return motion

    def move_to(self, step: PlanarMotion, valid_for_s: float) -> PlanarMotion:
        return self._tell("move_to", step, valid_for_s)

    def set_velocity(self, velocity: PlanarMotion, valid_for_s: float) -> PlanarMotion:
        return self._tell("set_velocity", velocity, valid_for_s)

    def renew(self, valid_for_s: float) -> None:
        self._tell("renew", self._told, valid_for_s)

    def stop(self) -> None:
        self._tell("stop", ZERO, 0.0)

    def status(self) -> WalkStatus:
        if self.broken:
            raise HalError(self.broken)
        now_ns = time.monotonic_ns()
        with self._lock:
            told = self._told if now_ns < self._ends_ns else ZERO
        return WalkStatus(now_ns, told != ZERO, self.fallen, told, ZERO)


class LeastHead:
    def __init__(self) -> None:
        self.told: list[HeadAngles] = []

    def look(self, target: HeadAngles, speed_rad_s: float) -> HeadAngles:
        self.told.append(target)
        return target


class LeastRobot:
    def __init__(self) -> None:
        self.clock = LeastClock()
        self.walk = LeastWalk()
        self.head = LeastHead()


class Set:
    """A walk server, its robot, and somebody who listens."""

    def __init__(self, folder: Path) -> None:
        self.robot = LeastRobot()
        self.bus = Bus(open_server(BusConfig(listen=())), "nao")
        self.server = WalkServer(self.robot, self.bus, Rules(), EstopLatch(folder))
        self._news = threading.Condition()
        self.states: list[WalkState] = []
        self.bus.subscribe("walk/state", WalkState, self._heard, pytest.fail)
        self.server.start()
        self._seq = 0

    def _heard(self, state: WalkState) -> None:
        with self._news:
            self.states.append(state)
            self._news.notify_all()

    def wait_for(self, what: Callable[[WalkState], bool]) -> WalkState:
        """The first state from now on for which something holds."""
        with self._news:
            begin = len(self.states)

            def found() -> WalkState | None:
                return next((s for s in self.states[begin:] if what(s)), None)

            assert self._news.wait_for(found, PATIENCE_S), f"not seen; last {self.states[-1:]}"
            state = found()
            assert state is not None
            return state

    def send(self, kind: str, source: str = "op", **fields: object) -> None:
        self._seq += 1
        command = {"source": source, "seq": self._seq, "kind": kind, **fields}
        self.bus.session.put(self.bus.key("walk/command"), json.dumps(command).encode())

    def close(self) -> None:
        self.server.close()
        self.bus.close()
