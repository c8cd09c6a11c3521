"""`naod run` in one process, `naod ctl` in others, over zenoh on loopback."""

from __future__ import annotations

import json
import math
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
import pytest
from daemon_process import NAOD, Daemon, Watch, naod

from hal.backends import OpenOptions, open_robot


@pytest.fixture(scope="module")
def daemon(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Daemon]:
    process = Daemon(tmp_path_factory.mktemp("daemon"))
    yield process
    process.kill()


@pytest.fixture(scope="module")
def region() -> str:
    """Where the can of the simulation's own world is in the first picture."""
    section = {"scenario": None, "scenario_folder": Path(), "seed": 0, "real_time": False}
    robot = open_robot("sim", OpenOptions(section=section))
    try:
        yuyv = robot.camera.next(1.0).yuyv
    finally:
        robot.close()
    rows, pairs = np.nonzero(yuyv[:, 1::2, 1] > 180)
    left, right = 2 * int(pairs.min()) + 6, 2 * int(pairs.max()) - 6
    top, bottom = int(rows.min()) + 8, int(rows.max()) - 8
    return f"{left},{top},{right - left},{bottom - top}"


def ego_of(truth: dict) -> tuple[float, float]:
    """Distance and bearing of the object from the base, in truth."""
    x, y, yaw = truth["base"]
    dx, dy = truth["object"][0] - x, truth["object"][1] - y
    return math.hypot(dx, dy), math.remainder(math.atan2(dy, dx) - yaw, 2.0 * math.pi)


def test_picture_shows_what_the_robot_sees(daemon: Daemon, tmp_path: Path) -> None:
    """Whoever is to label the object has to see it first."""
    done = daemon.ctl("picture", str(tmp_path / "view.jpg"))
    assert done.returncode == 0, done.stderr
    picture = cv2.imread(str(tmp_path / "view.jpg"))
    assert picture.shape == (480, 640, 3)
    red = (picture[..., 2] > 120) & (picture[..., 1] < 60)
    assert red.sum() > 500
    refused = daemon.ctl("picture", str(tmp_path / "view.bmp"))
    assert refused.returncode == 2
    assert ".jpg" in refused.stderr


def test_label_teach_start_watch_stop(daemon: Daemon, region: str) -> None:
    assert daemon.ctl("label", region).returncode == 0
    assert daemon.ctl("teach", "cup").returncode == 0
    with Watch(daemon.endpoint, "sim/truth", "state") as watch:
        shown = ego_of(watch.wait_for("sim/truth"))
        assert daemon.ctl("walk", "-0.08", "0.04", "0.1", "--for", "3").returncode == 0
        away = ego_of(watch.wait_for("sim/truth"))
        assert away[0] - shown[0] > 0.08
        done = daemon.ctl("start", "cup", "--wait", "--for", "90")
        assert done.returncode == 0, done.stdout + done.stderr
        assert "reached" in done.stdout
        there = ego_of(watch.wait_for("sim/truth"))
        assert there[0] == pytest.approx(shown[0], abs=0.02)
        assert there[1] == pytest.approx(shown[1], abs=math.radians(2.0))
        state = watch.wait_for("state")
        assert (state["mode"], state["phase"], state["goal"]) == ("track", "reached", "cup")
        assert state["target"]["found"]
        assert state["target"]["ego"]["rho_m"] == pytest.approx(there[0], rel=0.02)
    kept = daemon.folder / "state"
    assert (kept / "model.toml").exists()
    assert (kept / "goals" / "cup.toml").exists()


def test_stop_ends_an_approach(daemon: Daemon, region: str) -> None:
    assert daemon.ctl("walk", "-0.1", "0", "0", "--for", "3").returncode == 0
    with Watch(daemon.endpoint, "walk/state", "state") as watch:
        words = ("ctl", "--connect", daemon.endpoint, "start", "cup", "--wait")
        waiting = subprocess.Popen([*NAOD, *words], stdout=subprocess.PIPE, text=True)
        watch.wait_for("walk/state", lambda m: m["moving"] and m["last_source"] == "tracker")
        assert daemon.ctl("stop").returncode == 0
        watch.wait_for("walk/state", lambda m: not m["moving"])
        assert watch.wait_for("state")["mode"] == "track"
        assert watch.wait_for("state")["goal"] is None
    told, _ = waiting.communicate(timeout=10.0)
    assert waiting.returncode == 1
    assert "stopped on request" in told


def test_watch_prints_lines_for_people_and_for_programs(daemon: Daemon) -> None:
    shown = daemon.ctl("watch", "--for", "1.5").stdout.splitlines()
    assert 1 <= len(shown) <= 10
    lines = daemon.ctl("watch", "--for", "1.5", "--json").stdout.splitlines()
    documents = [json.loads(line) for line in lines]
    states = [d for d in documents if d["key"] == "state"]
    walks = [d for d in documents if d["key"] == "walk/state"]
    assert len(states) >= 5
    assert len(walks) >= 10
    assert any(d["key"] == "diagnostics" for d in documents)


def test_status_and_goals_as_json(daemon: Daemon) -> None:
    status = json.loads(daemon.ctl("status", "--json").stdout)
    assert status["ok"] is True
    assert status["robot"]["simulated"] is True
    assert status["goals"] == ["cup"]
    assert status["diagnostics"]["frames"] > 0
    (goal,) = json.loads(daemon.ctl("--json", "goals").stdout)["goals"]
    assert goal["name"] == "cup"
    assert goal["kind"] == "cylinder"


def test_head_turns_in_degrees_and_is_clipped(daemon: Daemon) -> None:
    told = json.loads(daemon.ctl("head", "-20", "5", "--for", "0.2", "--json").stdout)
    assert told["yaw"] == pytest.approx(math.radians(-20.0))
    told = json.loads(daemon.ctl("head", "0", "80", "--for", "0.2", "--json").stdout)
    assert told["pitch"] < math.radians(31.0)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("start", "nowhere"), "goal 'nowhere' was never taught; known: cup"),
        (("teach", "a b"), "goal name 'a b'"),
        (("label", "600,0,100,100"), "not inside the 640x480 picture"),
        (("label", "10,10,2,2"), "pixels"),
        (("walk", "nan", "0", "0"), "not a finite number"),
        (("walk", "11", "0", "0"), "out of range"),
        (("head", "720", "0"), "out of range"),
        (("--robot", "other", "status"), "robot 'other' does not answer"),
    ],
)
def test_bad_input_is_one_line_and_exit_status_2(
    daemon: Daemon, words: tuple[str, ...], told: str
) -> None:
    done = daemon.ctl(*words)
    assert done.returncode == 2
    assert told in done.stderr
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""


def test_number_that_is_not_finite_is_refused_on_the_bus(daemon: Daemon) -> None:
    with Watch(daemon.endpoint, "walk/state") as watch:
        key = watch.client.key("walk/command")
        payload = b'{"source":"x","seq":1,"kind":"velocity","x":NaN,"y":0,"yaw":0}'
        watch.client._session.put(key, payload)
        state = watch.wait_for("walk/state", lambda m: "not finite" in (m["refused"] or ""))
        assert not state["moving"]


def test_second_daemon_finds_the_port_in_use(daemon: Daemon) -> None:
    done = naod("run", "--config", str(daemon.config))
    assert done.returncode == 2
    assert f"cannot listen on {daemon.endpoint}: the port is in use" in done.stderr
    assert done.stderr.count("\n") == 1


def test_wrong_key_in_the_configuration_is_named_with_its_line(tmp_path: Path) -> None:
    path = tmp_path / "naod.toml"
    path.write_text("[robot]\nname = 'nao'\n\n[walk]\nspeed = 1.0\n")
    done = naod("run", "--config", str(path))
    assert done.returncode == 2
    assert f"{path}:5: walk.speed" in done.stderr
    assert done.stderr.count("\n") == 1


def test_remote_control_that_is_killed_leaves_a_standing_robot(daemon: Daemon) -> None:
    """S1, S2: measured at the robot."""
    with Watch(daemon.endpoint, "walk/state") as watch:
        words = ("ctl", "--connect", daemon.endpoint, "walk", "0", "0", "0.3", "--for", "60")
        remote = subprocess.Popen([*NAOD, *words])
        try:
            watch.wait_for("walk/state", lambda m: m["velocity"][2] > 0.0)
            held = watch.wait_for("walk/state", lambda m: m["moving"])
            assert held["held_by"] is not None
        finally:
            remote.send_signal(signal.SIGKILL)
            remote.wait()
        killed = watch.wait_for("walk/state")["stamp_ns"]
        zero = watch.wait_for("walk/state", lambda m: m["velocity"] == [0.0, 0.0, 0.0])
        # its last renewal was at most 0.1 s before it died, with a ttl of 0.3 s
        assert (zero["stamp_ns"] - killed) / 1e9 < 0.3 + 0.3
        still = watch.wait_for("walk/state", lambda m: not m["moving"])
        assert (still["stamp_ns"] - killed) / 1e9 < 0.3 + 1.2
        assert watch.wait_for("walk/state", lambda m: m["held_by"] is None)
