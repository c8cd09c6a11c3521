"""`naod robot`: a mistake is one line; what it serves is said; signals end it cleanly."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from naod.cli.main import main

NAOD = [sys.executable, "-m", "naod"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--speak", "dcm"], "--speak"),
        ([], "--speak"),
        (["--speak", "lola", "--seed", "-1"], "must not be negative"),
        (["--speak", "lola", "--url", "tcp://127.0.0.1:9559"], "--url: is for --speak naoqi"),
        (["--speak", "naoqi", "--socket", "/tmp/x"], "--socket: is for --speak lola"),
        (["--speak", "lola", "--size", "640"], "--size 640: not of"),
        (["--speak", "lola", "--fps", "99"], "fps: 99"),
        (["--speak", "lola", "--scenario", "none.toml"], "none.toml: no such file"),
        (["--speak", "lola", "--socket", "/nowhere/at/all"], "cannot listen"),
        (["--speak", "lola", "--socket", "s" * 200], "want unix:PATH"),
    ],
)
def test_mistake_is_one_line_and_exit_status_2(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    kept = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)]
    try:
        status = main(["robot", *words])
    except SystemExit as ended:
        status = int(ended.code or 0)
    finally:
        for number, handler in zip((signal.SIGINT, signal.SIGTERM), kept, strict=True):
            signal.signal(number, handler)
    assert status == 2
    told = capsys.readouterr()
    assert said in told.err
    assert told.err.count("\n") == 1
    assert told.out == ""


def test_scenario_for_another_robot_is_refused(tmp_path: Path) -> None:
    (tmp_path / "v5.toml").write_text('[robot]\nversion = "v5"\n')
    words = ("robot", "--speak", "lola", "--scenario", str(tmp_path / "v5.toml"))
    done = subprocess.run(
        [*NAOD, *words, "--socket", str(tmp_path / "s")],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert done.stderr == "naod robot: LoLA is of the V6, not of the v5\n"


def test_it_says_where_it_listens_and_an_interrupt_ends_it(tmp_path: Path) -> None:
    path = tmp_path / "robocup"
    robot = subprocess.Popen(
        [*NAOD, "robot", "--speak", "lola", "--socket", str(path), "--json"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert robot.stdout is not None
    served = json.loads(robot.stdout.readline())
    press = f"kill -USR1 {robot.pid}"
    assert served == {"speaks": "lola", "socket": str(path), "chest_button": press}
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as link:
        link.settimeout(10.0)
        link.connect(str(path))
        assert link.recv(896).startswith(b"\x8d\xa8Position")
        robot.send_signal(signal.SIGUSR1)
        pressed = b"\xa5Touch\x9e\xca\x3f\x80\x00\x00"
        assert any(pressed in link.recv(896, socket.MSG_WAITALL) for _ in range(200))
        assert any(pressed not in link.recv(896, socket.MSG_WAITALL) for _ in range(200))
    robot.send_signal(signal.SIGINT)
    out, error = robot.communicate(timeout=10.0)
    assert robot.returncode == 0
    assert out == ""
    assert "Traceback" not in error
    assert not os.path.exists(path)
