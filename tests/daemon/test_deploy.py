"""What is in deploy/ says the same as the code."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from naod.bus import keys
from naod.bus.schema import CALLED, main, schema_files
from naod.config import DaemonConfig, load_config
from naod.errors import InputError

DEPLOY = Path(__file__).parents[2] / "deploy"


def test_example_configuration_is_the_defaults() -> None:
    assert load_config(DEPLOY / "naod.toml") == DaemonConfig()


def test_example_configuration_names_every_key() -> None:
    text = (DEPLOY / "naod.toml").read_text()
    for section in DaemonConfig.__struct_fields__:
        assert f"[{section}]" in text
        value = getattr(DaemonConfig(), section)
        if value is None:
            continue
        part = text.split(f"[{section}]")[1].split("\n[")[0]
        for key in value.__struct_fields__:
            assert f"\n{key} = " in part or f"\n# {key} = " in part, f"[{section}] {key}"


def test_schema_files_are_those_of_the_messages() -> None:
    """If this fails: python -m naod.bus.schema deploy/schema"""
    there = {path.name: path.read_text() for path in (DEPLOY / "schema").glob("*.json")}
    assert there == schema_files()


def test_every_verb_has_a_schema() -> None:
    assert set(CALLED) == set(keys.VERBS)


def test_writing_schemas_removes_those_of_messages_that_are_gone(tmp_path: Path) -> None:
    (tmp_path / "gone.json").write_text("{}")
    main(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == set(schema_files())


def test_schemas_forbid_unknown_fields() -> None:
    for name, text in schema_files().items():
        for definition in json.loads(text)["$defs"].values():
            assert definition["additionalProperties"] is False, name


def test_unit_is_good_for_systemd(tmp_path: Path) -> None:
    program = shutil.which("systemd-analyze")
    if program is None:
        pytest.skip("systemd-analyze is not installed")
    # the program it starts is not installed here; any will do
    text = (DEPLOY / "naod.service").read_text()
    unit = tmp_path / "naod.service"
    unit.write_text(text.replace("/opt/naod/bin/naod run", "/bin/true"))
    done = subprocess.run(
        [program, "verify", "--man=no", str(unit)], capture_output=True, text=True, check=False
    )
    ours = [line for line in done.stderr.splitlines() if "naod.service" in line]
    assert done.returncode == 0, done.stderr
    assert ours == []


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[robot]\nnam = 'x'\n", ":2: robot.nam: "),
        ("[walk]\nspeed_max_m_s = inf\n", ":2: walk.speed_max_m_s: is not a finite number"),
        ("[camera]\nfps = 0\n", ":2: camera.fps: "),
        ("[camera]\nwidth = 320\n", ":1: camera: width x height 320x480"),
        ("[robot]\nname = 'a/b'\n", ":2: robot.name: "),
        ("[robot\n", "not valid TOML"),
    ],
)
def test_impossible_configuration_is_one_line_that_names_the_key(
    tmp_path: Path, text: str, words: str
) -> None:
    path = tmp_path / "naod.toml"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        load_config(path)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
