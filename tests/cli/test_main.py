"""The entry point: bad input is one line and exit status 2, whatever goes wrong."""

import subprocess
import sys

import cv2
import numpy as np
import pytest

from naod.cli.main import COMMANDS, main

NAOD = [sys.executable, "-m", "naod"]


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help(command, capsys):
    with pytest.raises(SystemExit) as ended:
        main([command, "--help"])
    assert ended.value.code == 0
    assert f"naod {command}" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["fly"], "invalid choice: 'fly'"),
        ([], "COMMAND"),
        (["demo", "--object", "cup"], "--object"),
        (["demo", "--seed", "-1"], "must not be negative"),
        (["demo", "--seed", "abc"], "--seed"),
        (["sim", "none.toml"], "none.toml: no such file"),
        (["sim", "none.toml", "--policy", "dance"], "--policy dance"),
        (["learn", "x.png", "--region", "1,2,3", "--out", "m.toml"], "region"),
        (["run", "--config", "none.toml"], "none.toml: no such file"),
        (["bench", "nothing"], "no benchmark 'nothing'"),
        (["ctl", "label", "1,2"], "region"),
    ],
)
def test_a_mistake_is_one_line_and_exit_status_2(words, said, capsys):
    try:
        status = main(words)
    except SystemExit as ended:
        status = ended.code
    shown = capsys.readouterr()
    assert status == 2
    assert said in shown.err
    assert shown.err.count("\n") == 1
    assert shown.out == ""


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('[object]\nkind = "rectangle"\nradius_m = 0.1\n', "object.radius_m"),
        ('[object]\ntexture = "none.png"\n', "object.texture"),
        ("[scene]\nlight = 0\n", "world.toml:2: scene.light"),
        ("[goal]\ndemonstrate_at = [9.0, 0.0, 0.0]\n", "demonstrate"),
        ('[walk]\nmodel = "dynamic"\n', "walk.model"),
    ],
)
def test_a_wrong_scenario_is_one_line(tmp_path, text, said, capsys):
    path = tmp_path / "world.toml"
    path.write_text(text)
    assert main(["sim", str(path)]) == 2
    shown = capsys.readouterr().err
    assert said in shown
    assert shown.count("\n") == 1


def test_output_that_cannot_be_written_is_one_line(tmp_path):
    """It used to be a traceback."""
    rng = np.random.default_rng(1)
    picture, model = tmp_path / "patch.png", tmp_path / "m.toml"
    patch = rng.normal((40.0, 60.0, 200.0), 4.0, (48, 64, 3))
    cv2.imwrite(str(picture), np.clip(patch, 0, 255).astype(np.uint8))
    words = ["learn", str(picture), "--region", "8,8,32,32", "--out", str(model), "--json"]
    words += ["--model-kind", "gaussian"]
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [*NAOD, *words], stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert done.returncode == 2
    assert done.stderr == "naod learn: output: No space left on device\n"
