"""The result goes into the configuration file, and nothing else in it changes."""

import os
import stat

import pytest

from naod.calibration.editing import with_camera, write_camera
from naod.config import DaemonConfig, load_config
from naod.errors import InputError

LINES = {"fx": "601.50", "correction_deg": "[1.000, -2.000, 3.000]"}


def test_values_are_replaced_and_comments_stay():
    text = "[camera]\nfx = 598.0  # nominal\n# fy = 1\ncorrection_deg = [0.0, 0.0, 0.0]\nfps = 10\n"
    assert with_camera(text, LINES) == (
        "[camera]\nfx = 601.50  # nominal\n# fy = 1\ncorrection_deg = [1.000, -2.000, 3.000]\n"
        "fps = 10\n"
    )


def test_an_array_over_several_lines_is_replaced_whole():
    text = "[camera]\ncorrection_deg = [\n  0.0, # roll\n  0.0,\n  0.0,\n] # end\n\n[walk]\n"
    assert with_camera(text, LINES) == (
        "[camera]\ncorrection_deg = [1.000, -2.000, 3.000] # end\nfx = 601.50\n\n[walk]\n"
    )


def test_a_section_that_is_not_there_is_added():
    assert with_camera("", LINES).startswith("[camera]\nfx = 601.50\n")
    assert with_camera("[walk]\n", LINES).startswith("[walk]\n\n[camera]\nfx")


def test_the_example_file_keeps_every_line_but_those(tmp_path):
    text = os.path.dirname(__file__) + "/../../deploy/naod.toml"
    with open(text, encoding="utf-8") as file:
        before = file.read()
    path = tmp_path / "naod.toml"
    path.write_text(before)
    path.chmod(0o600)
    write_camera(path, LINES)
    gone = set(before.splitlines()) - set(path.read_text().splitlines())
    assert all(line.startswith("correction_deg") for line in gone)
    assert load_config(path).camera.correction_deg == (1.0, -2.0, 3.0)
    assert load_config(path).camera.fx == 601.5
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert [p.name for p in tmp_path.iterdir()] == ["naod.toml"]


def test_a_link_stays_a_link(tmp_path):
    (tmp_path / "real.toml").write_text("[camera]\nfps = 10\n")
    link = tmp_path / "naod.toml"
    link.symlink_to("real.toml")
    write_camera(link, LINES)
    assert link.is_symlink()
    assert load_config(tmp_path / "real.toml").camera.fx == 601.5


@pytest.mark.parametrize(
    "text", ["camera = { fps = 10 }\n", "camera.fps = 10\n", '["camera"]\nfps = 10\n']
)
def test_what_cannot_be_changed_is_left_as_it_was(tmp_path, text):
    path = tmp_path / "naod.toml"
    path.write_text(text)
    assert load_config(path) != DaemonConfig()
    with pytest.raises(InputError, match="cannot be changed; paste it in"):
        write_camera(path, LINES)
    assert path.read_text() == text
