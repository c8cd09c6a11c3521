"""The simulated robot that speaks NAOqi, in a process of its own, and somebody to ask it."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import msgspec

from hal.backends import OpenOptions
from hal.errors import HalError
from hal.naoqi.robot import NaoqiRobot, open_robot
from hal.naoqi.session import Session
from hal.scenario import Scenario
from sim_backend.speak.naoqi import serve

READY_S = 180.0
"""The first start on a machine compiles kernels."""
PATIENCE_S = 20.0
SIZE = (160, 120)


def until(what: Callable[[], object], timeout_s: float = PATIENCE_S, pause_s: float = 0.01) -> Any:
    """Ask another process again and again until it answers with something true."""
    ends_s = time.monotonic() + timeout_s
    pause = threading.Event()
    while not (found := what()):
        assert time.monotonic() < ends_s, "it did not come to that"
        pause.wait(pause_s)
    return found


class Peer:
    """`serve` in another process. `told`: its own options; `ask` is a connection to it."""

    def __init__(self, version: str = "v6", scenario: str = "", **told: object) -> None:
        words = {"told": told, "version": version, "scenario": scenario}
        self.process = subprocess.Popen(
            [sys.executable, __file__, json.dumps(words)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        assert line, "the peer did not come to life"
        self.url: str = json.loads(line)["url"]
        self._ask: Session | None = None

    @property
    def ask(self) -> Session:
        """A connection of the test's own."""
        if self._ask is None or not self._ask.connected:
            self._ask = Session(self.url, None)
        return self._ask

    def world(self, method: str, *args: object) -> Any:
        """Ask SimWorld."""
        return self.ask.call("SimWorld", method, *args, timeout_s=5.0)

    def reset(self) -> None:
        """Awake, standing at its start, refusing nothing, as it was told at first."""
        self.world("reset")

    def again(self, method: str = "restart", *args: object) -> None:
        """Restart NAOqi, and wait until it is back."""
        self.world(method, *args)
        until(lambda: not self.ask_connected())
        until(self.is_back, pause_s=0.2)

    def ask_connected(self) -> bool:
        """Whether the test's own connection stands."""
        return self._ask is not None and self._ask.connected

    def is_back(self) -> bool:
        """Whether it answers."""
        try:
            self.world("truth")
        except HalError:
            return False
        return True

    def motion(self, method: str, *args: object) -> Any:
        """Ask ALMotion."""
        return self.ask.call("ALMotion", method, *args, timeout_s=5.0)

    def is_moving(self) -> bool:
        """In truth."""
        return bool(self.world("truth")["moving"])

    def robot(self, **more: Any) -> NaoqiRobot:
        """Open a robot on it, with small pictures."""
        fields = {key: more.pop(key) for key in ("camera", "version", "fps") if key in more}
        section = {"url": more.pop("url", self.url), **more}
        return open_robot(
            OpenOptions(name="test", width=SIZE[0], height=SIZE[1], section=section, **fields)
        )

    def close(self) -> None:
        """End it."""
        if self._ask is not None:
            self._ask.close()
        with suppress(OSError):
            self.process.send_signal(signal.SIGCONT)
        assert self.process.stdin is not None
        self.process.stdin.close()
        try:
            self.process.wait(10.0)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        assert self.process.stdout is not None
        self.process.stdout.close()


def main() -> None:
    words = json.loads(sys.argv[1])
    told = dict(words["told"])
    scenario = (
        msgspec.json.decode(words["scenario"].encode(), type=Scenario)
        if words["scenario"]
        else msgspec.json.decode(
            json.dumps({"robot": {"version": words["version"]}}).encode(), type=Scenario
        )
    )
    stop = threading.Event()

    def wait_for_the_end() -> None:
        os.read(0, 1)
        stop.set()

    threading.Thread(target=wait_for_the_end, daemon=True).start()
    size = tuple(told.pop("size", SIZE))
    section = {"scenario": scenario, "scenario_folder": Path(), "seed": 0, "naoqi": told}
    options = OpenOptions(width=size[0], height=size[1], section=section)
    serve(
        options, "tcp://127.0.0.1:0", None, stop, lambda said: print(json.dumps(said), flush=True)
    )


if __name__ == "__main__":
    main()
