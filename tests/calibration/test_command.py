"""`naod calibrate` from outside."""

import json

import cv2
import pytest

from naod.cli.main import main
from naod.config import load_config

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
mount_error_deg = [3.0, -4.0, 2.0]
"""
CONFIG = """
[sim]
scenario = "world.toml"
[robot]
state_folder = "{folder}"
[camera]
correction_deg = [0.0, 0.0, 0.0]
[gaze]
gain = 0.5
"""


@pytest.fixture
def config(tmp_path):
    (tmp_path / "world.toml").write_text(WORLD)
    path = tmp_path / "naod.toml"
    path.write_text(CONFIG.format(folder=tmp_path / "state"))
    return path


def refused(capsys, *words):
    assert main(["calibrate", *words]) == 2
    told = capsys.readouterr().err
    assert told.startswith("naod calibrate: ")
    assert told.count("\n") == 1
    return told


def test_mistakes_are_one_line(capsys, config, tmp_path):
    (tmp_path / "can.toml").write_text('kind = "cylinder"\n')
    at = ("--config", str(config))
    assert "want 6 to 100" in refused(capsys, *at, "--views", "3")
    assert "needs a --config" in refused(capsys, "--write")
    assert "is a cylinder" in refused(capsys, *at, "--object", str(tmp_path / "can.toml"))
    assert "no such file" in refused(capsys, "--config", str(tmp_path / "none.toml"))
    assert "--region" in refused(capsys, *at, "--region", "1,2,3")


def test_an_unknown_colour_is_told_before_anything_moves(capsys, config):
    assert "give --region or --model" in refused(capsys, "--config", str(config))


def test_what_it_finds_is_written_into_the_file(capsys, config, tmp_path):
    at = ("calibrate", "--config", str(config))
    picture = tmp_path / "view.png"
    assert main([*at, "--picture", str(picture)]) == 0
    assert cv2.imread(str(picture)).shape == (480, 640, 3)
    assert main([*at, "--region", "360,180,100,60", "--views", "8", "--write", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["correction_deg"] == pytest.approx([3.0, -4.0, 2.0], abs=0.2)
    assert told["written"] == str(config)
    found = load_config(config)
    assert found.camera.correction_deg == pytest.approx(told["correction_deg"], abs=1e-3)
    assert found.camera.fx == pytest.approx(told["camera"]["fx"], abs=1e-2)
    assert found.gaze.gain == 0.5


def test_what_does_not_show_a_rectangle_is_exit_one(capsys, config):
    before = config.read_text()
    # the grey of the room
    words = ["calibrate", "--config", str(config), "--region", "20,20,80,80", "--write"]
    assert main(words) == 1
    assert "not found" in capsys.readouterr().err
    assert config.read_text() == before
