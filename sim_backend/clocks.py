"""Time: virtual in lock-step, or the machine's own with the world running along in a thread."""

from __future__ import annotations

import threading
import time
from typing import Protocol

from hal.errors import BackendError
from sim_backend.world import TICK_NS, World


class WorldClock(Protocol):
    """A clock that also drives the world."""

    def now_ns(self) -> int: ...
    def sleep_until(self, deadline_ns: int) -> None: ...
    def advance(self, until_ns: int) -> None: ...
    def close(self) -> None: ...


class LockStepClock:
    """Virtual time: it stands still until somebody waits."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._now_ns = world.start_ns
        self._lock = threading.RLock()

    def now_ns(self) -> int:
        """Virtual time in ns."""
        return self._now_ns

    def sleep_until(self, deadline_ns: int) -> None:
        """Let the world run until then."""
        self.advance(deadline_ns)

    def advance(self, until_ns: int) -> None:
        """Let the world run until then; nothing if that has passed."""
        with self._lock:
            if until_ns > self._now_ns:
                self._world.run_to(until_ns)
                self._now_ns = until_ns

    def close(self) -> None:
        """Nothing to let go of."""


class RealClock:
    """The machine's monotonic time; a thread moves the world on at 100 Hz."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._closed = threading.Event()
        self._thread = threading.Thread(target=self._run, name="sim-world", daemon=True)
        self._thread.start()

    def now_ns(self) -> int:
        """Monotonic time in ns."""
        return time.monotonic_ns()

    def sleep_until(self, deadline_ns: int) -> None:
        """Return once `now_ns` has reached the deadline."""
        while (left := deadline_ns - time.monotonic_ns()) > 0:
            time.sleep(left / 1e9)

    def advance(self, until_ns: int) -> None:  # noqa: ARG002
        """Real time cannot be stepped. Raises BackendError."""
        raise BackendError("advance() is for lock-step only; this simulation runs in real time")

    def _run(self) -> None:
        deadline_ns = self._world.start_ns
        while not self._closed.is_set():
            # the recorded past stays ahead of the clock until the next tick
            self._world.run_to(deadline_ns + TICK_NS)
            deadline_ns += TICK_NS
            left = (deadline_ns - time.monotonic_ns()) / 1e9
            if left > 0.0:
                self._closed.wait(left)

    def close(self) -> None:
        """Stop the world's thread."""
        self._closed.set()
        if threading.current_thread() is not self._thread:
            self._thread.join(timeout=2.0)
