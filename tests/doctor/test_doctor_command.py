"""`naod doctor` from outside."""

import json
import socket

import pytest

from naod.cli.main import main

pytest.importorskip("sim_backend.backend")


@pytest.fixture
def config(tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    path = tmp_path / "naod.toml"
    path.write_text(
        f'[robot]\nstate_folder = "{tmp_path}/state"\n'
        f'[bus]\nlisten = ["tcp/127.0.0.1:{port}"]\n[camera]\nwidth = 160\nheight = 120\n'
    )
    return path


def test_a_simulated_robot_is_well(capsys, config):
    assert main(["doctor", "--config", str(config), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["ok"] is True
    checks = {finding["check"] for finding in told["findings"]}
    assert {"configuration", "state folder", "machine", "bus", "simulation", "camera"} <= checks
    assert sorted(path.name for path in config.parent.iterdir()) == ["naod.toml"]


def test_what_fails_is_exit_one_with_what_to_do(capsys, config):
    config.write_text(config.read_text() + '[sim]\nscenario = "none.toml"\n')
    assert main(["doctor", "--config", str(config)]) == 1
    rows = capsys.readouterr().out.splitlines()
    (failed,) = [row for row in rows if row.startswith("fail ")]
    assert "none.toml: no such file" in failed
    assert " -> " in failed


def test_a_wrong_file_is_exit_two_in_one_line(capsys, config):
    config.write_text("[robot]\nnam = 'x'\n")
    assert main(["doctor", "--config", str(config)]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    assert ":2: robot.nam" in captured.err
