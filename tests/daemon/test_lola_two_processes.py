"""`naod run` with backend lola in one process, `naod robot --speak lola` in another.

The daemon has no walk there; everything else is to be as in the simulation in one process.
"""

from __future__ import annotations

import json
import math
import subprocess
import threading
from collections.abc import Iterator
from pathlib import Path

import cv2
import msgspec
import numpy as np
import pytest
from daemon_process import NAOD, Daemon, Watch

from hal.backends import OpenOptions, open_robot
from hal.scenario import Scenario
from naod.config import DaemonConfig
from naod.experiment.opening import open_lockstep
from naod.loop.types import Label
from naod.perception.colour_model import Region

LOOKS, SETTLING = 20, 20
CAN = (1.2, 0.0, 0.4575)
NOISE = {"rho_m": 0.006, "theta_rad": 0.003, "z_m": 0.003}
"""A stated sigma of one look: the head comes to rest a little elsewhere in each run, and all looks
of a run share what its encoders say there."""

COMPILING_S = 120.0


class Robot:
    """`naod robot --speak lola` in a folder, its lines on stderr kept."""

    def __init__(self, folder: Path) -> None:
        words = ("robot", "--speak", "lola", "--socket", str(folder / "robocup"))
        self.process = subprocess.Popen(
            [*NAOD, *words, "--camera", "0", "--json"],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        assert self.process.stdout is not None
        assert self.process.stderr is not None
        self.served = json.loads(self.process.stdout.readline())
        self._news = threading.Condition()
        self.lines: list[str] = []
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self) -> None:
        assert self.process.stderr is not None
        for line in self.process.stderr:
            with self._news:
                self.lines.append(line.rstrip())
                self._news.notify_all()

    def wait_for_line(self, part: str) -> str:
        with self._news:
            assert self._news.wait_for(lambda: any(part in x for x in self.lines), 15.0), self.lines
            return next(line for line in self.lines if part in line)

    def close(self) -> int:
        self.process.terminate()
        status = self.process.wait(10.0)
        self._reader.join()
        for stream in (self.process.stdout, self.process.stderr):
            assert stream is not None
            stream.close()
        return status


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Robot]:
    made = Robot(tmp_path_factory.mktemp("robot"))
    yield made
    assert made.close() == 0


@pytest.fixture(scope="module")
def daemon(robot: Robot, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Daemon]:
    more = (
        f'[lola]\nsocket = "{robot.served["socket"]}"\n\n'
        f'[camera]\ndevice = "{robot.served["camera"]}"\n'
    )
    made = Daemon(tmp_path_factory.mktemp("daemon"), more, backend="lola")
    yield made
    made.kill()


@pytest.fixture(scope="module")
def region() -> Region:
    """Where the can is in the first picture, of either robot."""
    section = {"scenario": None, "scenario_folder": Path(), "seed": 0, "real_time": False}
    robot = open_robot("sim", OpenOptions(section=section))
    try:
        yuyv = robot.camera.next(1.0).yuyv
    finally:
        robot.close()
    rows, pairs = np.nonzero(yuyv[:, 1::2, 1] > 180)
    left, right = 2 * int(pairs.min()) + 6, 2 * int(pairs.max()) - 6
    top, bottom = int(rows.min()) + 8, int(rows.max()) - 8
    return Region(left, top, right - left, bottom - top)


def errors(egos: list[dict[str, float]]) -> dict[str, float]:
    """Median error of many looks, against where the can really is from the base at the origin."""
    x, y, z = CAN
    true = {"rho_m": math.hypot(x, y), "theta_rad": math.atan2(y, x), "z_m": z}
    return {
        name: float(np.median([abs(ego[name] - value) for ego in egos]))
        for name, value in true.items()
    }


def in_process(region: Region) -> dict[str, float]:
    """The same looks by the simulated robot in lock-step, in this process."""
    lockstep = open_lockstep(DaemonConfig(), Scenario(), Path(), 0, compare_paper=False)
    try:
        label = Label(region.x, region.y, region.width, region.height)
        assert lockstep.ask(label).error_code is None
        for _ in range(SETTLING):
            lockstep.tick()
        egos = []
        for _ in range(LOOKS):
            ego = lockstep.tick().commands.state.target.ego
            assert ego is not None
            egos.append(msgspec.to_builtins(ego))
        return errors(egos)
    finally:
        lockstep.robot.close()


def test_restart_moves_nothing_and_the_walk_is_idle(daemon: Daemon) -> None:
    """S8: the robot is held in the pose it was found in."""
    status = json.loads(daemon.ctl("status", "--json").stdout)
    assert status["robot"]["backend"] == "lola"
    assert status["robot"]["simulated"] is False
    assert status["state"]["mode"] == "idle"
    with Watch(daemon.endpoint, "walk/state") as watch:
        state = watch.wait_for("walk/state")
    assert not state["moving"]
    assert not state["fallen"]


def test_centres_and_localises_as_well_as_in_one_process(
    daemon: Daemon, region: Region, tmp_path: Path
) -> None:
    words = f"{region.x},{region.y},{region.width},{region.height}"
    done = daemon.ctl("label", words)
    assert done.returncode == 0, done.stderr
    egos = []
    with Watch(daemon.endpoint, "state") as watch:
        for _ in range(SETTLING):
            watch.wait_for("state", timeout_s=COMPILING_S)
        for _ in range(LOOKS):
            egos.append(watch.wait_for("state", lambda m: m["target"]["ego"])["target"]["ego"])
    through_lola, alone = errors(egos), in_process(region)
    assert through_lola["rho_m"] < 0.012, "a hundredth of the distance"
    for name, error in alone.items():
        assert through_lola[name] < 2.0 * error + NOISE[name], (through_lola, alone)
    assert daemon.ctl("picture", str(tmp_path / "view.jpg")).returncode == 0
    picture = cv2.imread(str(tmp_path / "view.jpg"))
    rows, columns = np.nonzero((picture[..., 2] > 120) & (picture[..., 1] < 60))
    assert abs(columns.mean() - 319.5) < 40.0
    assert abs(rows.mean() - 239.5) < 40.0


def test_walk_is_refused_and_walk_state_says_why(daemon: Daemon) -> None:
    with Watch(daemon.endpoint, "walk/state") as watch:
        words = ("ctl", "--connect", daemon.endpoint, "walk", "0.05", "0", "0", "--for", "2")
        walking = subprocess.Popen([*NAOD, *words], stderr=subprocess.DEVNULL)
        state = watch.wait_for("walk/state", lambda m: "walking engine" in (m["refused"] or ""))
        walking.wait(20.0)
        moved = [m for m in watch.heard["walk/state"] if m["moving"] or m["velocity"] != [0, 0, 0]]
    assert state["held_by"] is None
    assert not moved


def test_end_of_the_daemon_is_a_robot_that_sits_with_free_joints(
    daemon: Daemon, robot: Robot
) -> None:
    assert daemon.terminate() == 0
    line = robot.wait_for_line("the client has gone")
    assert line.endswith("the robot sits, its joints free")
    assert any("the last message was safe" in line for line in daemon.lines)
