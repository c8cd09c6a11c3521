"""A daemon in a process of its own, on a free loopback port, and somebody who listens to it."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from naod.bus.client import Client

READY_S = 180.0
"""The first start on a machine compiles kernels."""

PATIENCE_S = 20.0
NAOD = [sys.executable, "-m", "naod"]


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def naod(*words: str, timeout_s: float = 120.0) -> subprocess.CompletedProcess[str]:
    """Run a command to its end."""
    return subprocess.run(
        [*NAOD, *words], capture_output=True, text=True, timeout=timeout_s, check=False
    )


class Daemon:
    """`naod run` with a state folder; `ctl` are verbs from another process."""

    def __init__(
        self,
        folder: Path,
        more: str = "",
        environment: dict[str, str] | None = None,
        backend: str = "sim",
    ):
        self.folder = folder
        self.endpoint = f"tcp/127.0.0.1:{free_port()}"
        self.config = folder / "naod.toml"
        self.config.write_text(
            f'[robot]\nstate_folder = "{folder / "state"}"\nbackend = "{backend}"\n'
            f'[bus]\nlisten = ["{self.endpoint}"]\n{more}'
        )
        self._environment = {**os.environ, **(environment or {})}
        self.lines: list[str] = []
        self.start()

    def start(self) -> None:
        """Start and wait until it is ready."""
        self.process = subprocess.Popen(
            [*NAOD, "run", "--config", str(self.config)],
            stderr=subprocess.PIPE,
            text=True,
            env=self._environment,
        )
        ready = threading.Event()
        self._reader = threading.Thread(target=self._read, args=(ready,))
        self._reader.start()
        if not ready.wait(READY_S) or self.process.poll() is not None:
            self.kill()
            raise AssertionError("not ready: " + "".join(self.lines))

    def _read(self, ready: threading.Event) -> None:
        assert self.process.stderr is not None
        for line in self.process.stderr:
            self.lines.append(line)
            if line.rstrip().endswith(": ready"):
                ready.set()
        ready.set()

    def ctl(self, *words: str) -> subprocess.CompletedProcess[str]:
        """A verb, in another process."""
        return naod("ctl", "--connect", self.endpoint, *words)

    def terminate(self) -> int:
        """SIGTERM; the exit status."""
        self.process.send_signal(signal.SIGTERM)
        status = self.process.wait(10.0)
        self._reader.join()
        return status

    def kill(self) -> None:
        """SIGKILL, if it still runs."""
        self.process.kill()
        self.process.wait()
        self._reader.join()


class Watch:
    """Listens to some names; can wait for what it hears."""

    def __init__(self, endpoint: str, *names: str) -> None:
        self.client = Client(endpoint, "nao")
        self._news = threading.Condition()
        self.heard: dict[str, list[dict[str, Any]]] = {name: [] for name in names}
        for name in names:
            self.client.listen(name, lambda payload, name=name: self._take(name, payload))
        self.client.call("watch")

    def _take(self, name: str, payload: bytes) -> None:
        with self._news:
            self.heard[name].append(json.loads(payload))
            self._news.notify_all()

    def wait_for(
        self,
        name: str,
        what: Callable[[dict[str, Any]], bool] = lambda _message: True,
        timeout_s: float = PATIENCE_S,
    ) -> dict[str, Any]:
        """The first message from now on for which something holds."""
        with self._news:
            begin = len(self.heard[name])

            def found() -> dict[str, Any] | None:
                return next((m for m in self.heard[name][begin:] if what(m)), None)

            assert self._news.wait_for(found, timeout_s), f"{name}: {self.heard[name][-1:]}"
            message = found()
            assert message is not None
            return message

    def __enter__(self) -> Watch:
        return self

    def __exit__(self, *_error: object) -> None:
        self.client.close()
