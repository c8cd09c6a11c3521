"""The simulated robot and its LoLA, in threads of the test's process."""

from __future__ import annotations

import threading
import time
from pathlib import Path

import numpy as np

from hal.scenario import Scenario
from sim_backend.clocks import RealClock
from sim_backend.defaults import resolved
from sim_backend.speak.lola_body import JointWorld
from sim_backend.speak.lola_server import LolaServer


class Peer:
    """Stands or sits as `angles` (26,) have it; `lines` are what its LoLA says."""

    def __init__(self, folder: Path, angles: np.ndarray) -> None:
        self.path = str(folder / "robocup")
        self.world = JointWorld(resolved(Scenario()), "v6", 0, time.monotonic_ns, angles)
        self._clock = RealClock(self.world)
        self.lines: list[str] = []
        self._news = threading.Condition()
        self.server = LolaServer(self.path, self.world, self._say)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self.server.run, args=(self._stop,))
        self._thread.start()

    def _say(self, text: str) -> None:
        with self._news:
            self.lines.append(text)
            self._news.notify_all()

    def wait_for_line(self, part: str, timeout_s: float = 15.0) -> str:
        with self._news:
            found = self._news.wait_for(
                lambda: next((line for line in self.lines if part in line), None), timeout_s
            )
        assert found, self.lines
        return found

    def wait_until(self, what, timeout_s: float = 15.0) -> None:
        """Until something holds of the true joint angles; looked at as often as they change."""
        limit = time.monotonic() + timeout_s
        tick = threading.Event()
        while not what(self.world.angles_rad):
            assert time.monotonic() < limit, self.world.angles_rad
            tick.wait(0.005)

    def close(self) -> None:
        self._stop.set()
        self._thread.join()
        self._clock.close()
