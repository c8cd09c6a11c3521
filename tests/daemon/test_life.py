"""A daemon's life: systemd, estop over restarts, what a restart does and does not do."""

from __future__ import annotations

import os
import signal
import socket
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from daemon_process import Daemon, Watch


@pytest.fixture
def systemd(tmp_path: Path) -> Iterator[socket.socket]:
    """The socket that systemd would listen on."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as listener:
        listener.bind(str(tmp_path / "notify"))
        listener.settimeout(10.0)
        yield listener


def test_estop_holds_over_a_kill_and_a_restart_moves_nothing(
    tmp_path: Path, systemd: socket.socket
) -> None:
    """S5 and S8, and what systemd is told meanwhile."""
    daemon = Daemon(tmp_path, environment={"NOTIFY_SOCKET": str(tmp_path / "notify")})
    try:
        _estop_while_walking(daemon)
        daemon.kill()
        _drain(systemd)
        daemon.start()
        _still_latched(daemon)
        _watchdog_is_fed(systemd)
        begin = time.monotonic()
        assert daemon.terminate() == 0, "".join(daemon.lines)
        assert time.monotonic() - begin < 2.0
        assert b"STOPPING=1" in _drain(systemd)
    finally:
        daemon.kill()


def _estop_while_walking(daemon: Daemon) -> None:
    with Watch(daemon.endpoint, "walk/state", "event") as watch:
        watch.client.call("status")
        walk = b'{"source":"op","seq":1,"kind":"velocity","x":0.08,"ttl_ms":1000}'
        watch.client._session.put(watch.client.key("walk/command"), walk)
        moving = watch.wait_for("walk/state", lambda m: m["velocity"][0] > 0.0)
        assert moving["held_by"] == "op"
        asked = time.monotonic_ns()
        watch.client.call("estop")
        zero = watch.wait_for("walk/state", lambda m: m["velocity"] == [0.0, 0.0, 0.0])
        # the simulated robot's clock is this machine's monotonic one
        assert (zero["stamp_ns"] - asked) / 1e9 < 0.1 + 0.04
        assert "estop" in [event["kind"] for event in watch.heard["event"]]


def _still_latched(daemon: Daemon) -> None:
    with Watch(daemon.endpoint, "walk/state", "state", "sim/truth") as watch:
        assert watch.wait_for("state")["mode"] == "idle"
        before = watch.wait_for("sim/truth")["base"]
        assert watch.client.call("status")["estopped"] is True
        refused = daemon.ctl("walk", "0.05", "0", "0")
        assert refused.returncode == 2
        assert "estop is latched" in refused.stderr
        assert daemon.ctl("start", "cup").returncode == 2
        assert daemon.ctl("release").returncode == 0
        released = watch.wait_for("walk/state")["seq"]
        watch.wait_for("walk/state", lambda m: m["seq"] > released + 25)
        assert watch.wait_for("sim/truth")["base"] == before
        assert all(not state["moving"] for state in watch.heard["walk/state"])


def _watchdog_is_fed(systemd: socket.socket) -> None:
    told = _drain(systemd)
    assert b"READY=1" in told
    begin = time.monotonic()
    for _ in range(10):
        assert systemd.recv(200) == b"WATCHDOG=1"
    assert time.monotonic() - begin < 2.0


def _drain(systemd: socket.socket) -> list[bytes]:
    told = []
    systemd.setblocking(False)
    try:
        while True:
            told.append(systemd.recv(200))
    except BlockingIOError:
        systemd.settimeout(10.0)
    return told


def test_hung_daemon_feeds_no_watchdog(tmp_path: Path, systemd: socket.socket) -> None:
    daemon = Daemon(tmp_path, environment={"NOTIFY_SOCKET": str(tmp_path / "notify")})
    try:
        systemd.recv(200)
        os.kill(daemon.process.pid, signal.SIGSTOP)
        _drain(systemd)
        systemd.settimeout(0.6)
        with pytest.raises(TimeoutError):
            systemd.recv(200)
        os.kill(daemon.process.pid, signal.SIGCONT)
        systemd.settimeout(5.0)
        assert systemd.recv(200) == b"WATCHDOG=1"
        # Ctrl-C in a terminal is as good as systemd's SIGTERM; right after SIGCONT the kernel may
        # hand it to a thread other than the main one, which once slept on without noticing
        daemon.process.send_signal(signal.SIGINT)
        assert daemon.process.wait(5.0) == 0
    finally:
        daemon.kill()
