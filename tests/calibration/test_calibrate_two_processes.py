"""`naod calibrate` on a robot in another process, through the protocol of a real one."""

import contextlib
import json
import signal
import subprocess
import sys

import pytest

from naod.cli.main import main

pytest.importorskip("sim_backend.backend")

WORLD = """
[robot]
start = [0.75, 0.05, 0.0]
[object]
kind = "rectangle"
position = [1.6, 0.0, 0.52]
yaw_deg = 160.0
[scene]
table = false
[camera]
mount_error_deg = [5.0, -5.0, 5.0]
"""
CONFIG = """
[robot]
backend = "{protocol}"
state_folder = "{folder}/state"
[object]
kind = "rectangle"
width_m = 0.3
height_m = 0.2
"""


@contextlib.contextmanager
def robot(folder, protocol, *words):
    """`naod robot`, listening; what it says of where."""
    world = folder / "world.toml"
    world.write_text(WORLD)
    command = [sys.executable, "-m", "naod", "robot", "--speak", protocol, "--json"]
    process = subprocess.Popen(
        [*command, "--scenario", str(world), *words], stdout=subprocess.PIPE, text=True
    )
    try:
        assert process.stdout is not None
        line = process.stdout.readline()
        assert line, "the robot did not come to life"
        yield json.loads(line)
    finally:
        process.send_signal(signal.SIGTERM)
        process.wait(30.0)
        process.stdout.close()


def found(capsys, path):
    words = ["calibrate", "--config", str(path), "--region", "360,160,120,80", "--json"]
    assert main(words) == 0, capsys.readouterr().err
    return json.loads(capsys.readouterr().out)["correction_deg"]


@pytest.mark.slow
def test_through_lola(capsys, tmp_path):
    path, camera = tmp_path / "naod.toml", tmp_path / "camera"
    listen = ("--socket", str(tmp_path / "robocup"), "--camera", str(camera))
    with robot(tmp_path, "lola", *listen) as served:
        path.write_text(
            CONFIG.format(protocol="lola", folder=tmp_path)
            + f'[lola]\nsocket = "{served["socket"]}"\nstand_up = "start"\n'
            + f'[camera]\ndevice = "{served["camera"]}"\n'
        )
        assert found(capsys, path) == pytest.approx([5.0, -5.0, 5.0], abs=0.1)


@pytest.mark.slow
def test_through_naoqi(capsys, tmp_path):
    pytest.importorskip("qi", reason="the package qi is not installed")
    path = tmp_path / "naod.toml"
    with robot(tmp_path, "naoqi", "--url", "tcp://127.0.0.1:0") as served:
        path.write_text(
            CONFIG.format(protocol="naoqi", folder=tmp_path) + f'[naoqi]\nurl = "{served["url"]}"\n'
        )
        assert found(capsys, path) == pytest.approx([5.0, -5.0, 5.0], abs=0.1)
