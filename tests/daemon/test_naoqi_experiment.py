"""Teach and approach through NAOqi: the daemon in one process, the robot in another, zenoh between.

The same verbs to a daemon with the simulation inside give the same result within its noise.
"""

from __future__ import annotations

import json
import math
import signal
import subprocess
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from daemon_process import NAOD, Daemon, Watch

from hal.backends import OpenOptions, open_robot

pytest.importorskip("qi", reason="the package qi is not installed")

from hal.naoqi.session import Session

SIZE = (320, 240)
CAMERA = f"[camera]\nwidth = {SIZE[0]}\nheight = {SIZE[1]}\n"
WITHIN_M, WITHIN_RAD = 0.02, math.radians(2.0)
"""What the simulation itself promises for every seed."""


class Peer:
    """`naod robot --speak naoqi`."""

    def __init__(self) -> None:
        size = f"{SIZE[0]}x{SIZE[1]}"
        words = ["robot", "--speak", "naoqi", "--url", "tcp://127.0.0.1:0", "--size", size]
        self._process = subprocess.Popen(
            [*NAOD, *words, "--json"], stdout=subprocess.PIPE, text=True
        )
        assert self._process.stdout is not None
        self.url = json.loads(self._process.stdout.readline())["url"]
        self.session = Session(self.url, None)

    def truth(self) -> dict[str, Any]:
        """What is so."""
        return dict(self.session.call("SimWorld", "truth", timeout_s=5.0))

    def terminate(self) -> int:
        """SIGTERM; the exit status. May be called twice."""
        if self._process.poll() is not None:
            return self._process.returncode
        self.session.close()
        self._process.send_signal(signal.SIGTERM)
        status = self._process.wait(10.0)
        assert self._process.stdout is not None
        self._process.stdout.close()
        return status


def region() -> str:
    """Where the can is in the first picture."""
    section = {"scenario": None, "scenario_folder": Path(), "seed": 0, "real_time": False}
    robot = open_robot("sim", OpenOptions(width=SIZE[0], height=SIZE[1], section=section))
    try:
        yuyv = robot.camera.next(1.0).yuyv
    finally:
        robot.close()
    rows, pairs = np.nonzero(yuyv[:, 1::2, 1] > 180)
    left, right = 2 * int(pairs.min()) + 4, 2 * int(pairs.max()) - 4
    top, bottom = int(rows.min()) + 4, int(rows.max()) - 4
    return f"{left},{top},{right - left},{bottom - top}"


def ego_of(truth: dict[str, Any]) -> tuple[float, float]:
    """Distance and bearing of the object from the base."""
    x, y, yaw = truth["base"]
    dx, dy = truth["object"][0] - x, truth["object"][1] - y
    return math.hypot(dx, dy), math.remainder(math.atan2(dy, dx) - yaw, 2.0 * math.pi)


def experiment(daemon: Daemon, truth: Callable[[], dict[str, Any]]) -> tuple[float, float]:
    """Show a pose, go elsewhere, come back by sight: error of distance and of bearing."""
    for words in (("label", region()), ("teach", "cup")):
        done = daemon.ctl(*words)
        assert done.returncode == 0, done.stderr + "".join(daemon.lines)
    shown = ego_of(truth())
    done = daemon.ctl("walk", "-0.08", "0.04", "0.1", "--for", "3")
    assert done.returncode == 0, done.stderr
    away = ego_of(truth())
    assert away[0] - shown[0] > 0.08
    done = daemon.ctl("start", "cup", "--wait", "--for", "120")
    assert done.returncode == 0, done.stdout + done.stderr + "".join(daemon.lines)
    there = ego_of(truth())
    return there[0] - shown[0], there[1] - shown[1]


@pytest.fixture
def stack() -> Iterator[ExitStack]:
    with ExitStack() as found:
        yield found


def through_naoqi(stack: ExitStack, folder: Path) -> tuple[Daemon, Peer]:
    peer = Peer()
    stack.callback(peer.terminate)
    more = f'{CAMERA}[naoqi]\nurl = "{peer.url}"\n'
    daemon = Daemon(folder, more, backend="naoqi")
    stack.callback(daemon.kill)
    return daemon, peer


def in_process(stack: ExitStack, folder: Path) -> tuple[float, float]:
    daemon = Daemon(folder, CAMERA)
    stack.callback(daemon.kill)
    watch = stack.enter_context(Watch(daemon.endpoint, "sim/truth"))
    return experiment(daemon, lambda: watch.wait_for("sim/truth"))


@pytest.mark.slow
def test_experiment_through_naoqi_and_in_process(stack: ExitStack, tmp_path: Path) -> None:
    for name in ("naoqi", "sim"):
        (tmp_path / name).mkdir()
    daemon, peer = through_naoqi(stack, tmp_path / "naoqi")
    through = experiment(daemon, peer.truth)
    assert daemon.terminate() == 0
    assert not peer.truth()["moving"]
    assert peer.session.call("ALAutonomousLife", "getState") == "solitary"
    assert peer.session.call("ALVideoDevice", "getSubscribers") == []
    assert peer.terminate() == 0
    within = in_process(stack, tmp_path / "sim")
    for distance, bearing in (through, within):
        assert abs(distance) < WITHIN_M
        assert abs(bearing) < WITHIN_RAD
