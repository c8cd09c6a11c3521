"""Files: errors name file, line and key; writing is whole or not at all."""

import os

import msgspec
import pytest

from hal.scenario import Scenario
from naod.config import DaemonConfig
from naod.errors import InputError
from naod.files import parse_toml, read_toml, write_toml, write_whole
from naod.geometry.camera import PinholeCamera


@pytest.mark.parametrize(
    ("text", "kind", "expected"),
    [
        ("[robot]\nname = 'a'\n\n[gaze]\ngian = 1\n", DaemonConfig, "f.toml:5: gaze.gian"),
        ("[gaze]\n\ngain = 'x'\n", DaemonConfig, "f.toml:3: gaze.gain"),
        ("[camera]\nwidth = 123\n", DaemonConfig, "f.toml:2: camera.width"),
        ("[robots]\n", DaemonConfig, "f.toml:1: robots"),
        ("[robot]\nstart = [1, 2]\n", Scenario, "f.toml:2: robot.start"),
        ("[scene]\nlight = -1.0\n", Scenario, "f.toml:2: scene.light"),
        ("[[distractor]]\nkind = 'cube'\n", Scenario, "f.toml:2: distractor.kind"),
        ("width = 3\n", PinholeCamera, "f.toml: height: is missing"),
        ("[robot\n", DaemonConfig, "f.toml: not valid TOML"),
        ("[gaze]\ngain = nan\n", DaemonConfig, "gaze.gain"),
        ("[walk]\nspeed_max_m_s = inf\n", DaemonConfig, "f.toml:2: walk.speed_max_m_s: is not a"),
        ("[object]\nposition = [0.0, nan, 1.0]\n", Scenario, "f.toml:2: object.position: is not"),
    ],
)
def test_errors_name_the_key_and_its_line(text, kind, expected):
    with pytest.raises(InputError) as caught:
        parse_toml(text, kind, "f.toml")
    assert expected in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_missing_file_is_one_line(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        read_toml(tmp_path / "none.toml", DaemonConfig)


def test_toml_round_trip(tmp_path):
    camera = PinholeCamera(width=4, height=2, fx=1.5, fy=2.0, cx=1.0, cy=0.5)
    write_toml(tmp_path / "c.toml", camera)
    assert read_toml(tmp_path / "c.toml", PinholeCamera) == camera


def test_whole_or_not_at_all(tmp_path, monkeypatch):
    path = tmp_path / "goal.toml"
    write_whole(path, "old")

    def fail(*args):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", fail)
    with pytest.raises(InputError, match="No space left"):
        write_whole(path, "new")
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["goal.toml"]


def test_defaults_are_valid():
    assert msgspec.convert(msgspec.to_builtins(DaemonConfig()), DaemonConfig) == DaemonConfig()
