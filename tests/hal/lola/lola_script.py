"""A LoLA whose every byte the test decides: sends what it is told, when it is told."""

from __future__ import annotations

import os
import select
import signal
import socket
import struct
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from lola_literal import FIELDS, POSITION, SENSOR_FRAME, STIFFNESS

from hal.lola.layout import LOLA_JOINTS
from hal.lola.line import Line
from hal.lola.poses import STAND
from hal.lola.shared import LolaStatus
from hal.lola.spawn import hired
from hal.lola.told import Told
from hal.nao.joints import JOINT_INDEX

PATIENCE_S = 10.0


@dataclass(frozen=True)
class Reply:
    """The joints' part of an actuator message, read by struct alone: (25,) each."""

    position: np.ndarray
    stiffness: np.ndarray

    def angle(self, joint: str) -> float:
        return float(self.position[LOLA_JOINTS.index(joint)])


def frame(angles: dict[str, float] | None = None, stiffness: float = 0.0) -> bytes:
    """A sensor message of a robot that stands, its chest button up."""
    values = [float(STAND[JOINT_INDEX[name]]) for name in LOLA_JOINTS]
    for name, value in (angles or {}).items():
        values[LOLA_JOINTS.index(name)] = value
    swap = {
        POSITION: b"\xa8Position\xdc\x00\x19" + b"".join(_single(v) for v in values),
        STIFFNESS: b"\xa9Stiffness\xdc\x00\x19" + _single(stiffness) * 25,
    }
    made = b"\x8d" + b"".join(swap.get(field, field) for field in FIELDS)
    made = made.replace(b"\xa5Touch\x9e" + _single(1.0), b"\xa5Touch\x9e" + _single(0.0))
    upright = b"\xa6Angles\x92" + _single(0.0) * 2
    made = made.replace(b"\xa6Angles\x92" + _single(0.125) + _single(-0.5), upright)
    assert len(made) == len(SENSOR_FRAME)
    return made


def _single(value: float) -> bytes:
    return b"\xca" + struct.pack(">f", value)


class ScriptedLola:
    """Listens at a path; one client at a time."""

    def __init__(self, folder: Path) -> None:
        self.path = str(folder / "robocup")
        self._listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._listener.bind(self.path)
        self._listener.listen(4)
        self._listener.settimeout(PATIENCE_S)
        self.client: socket.socket | None = None

    def accept(self) -> None:
        """Wait for a client; one that was there before is hung up on."""
        self.hang_up()
        self.client, _ = self._listener.accept()
        self.client.settimeout(PATIENCE_S)

    def send(self, data: bytes) -> None:
        assert self.client is not None
        self.client.sendall(data)

    def reply(self) -> Reply:
        """Wait for one whole actuator message."""
        assert self.client is not None
        data = b""
        while len(data) < 786:
            more = self.client.recv(786 - len(data))
            assert more, "the client hung up"
            data += more
        assert data.startswith(b"\x8b\xa8Position\xdc\x00\x19")
        assert data[138:151] == b"\xa9Stiffness\xdc\x00\x19"
        tables = [np.frombuffer(data[at : at + 125], np.uint8) for at in (13, 151)]
        return Reply(
            *(t.reshape(25, 5)[:, 1:].copy().view(">f4")[:, 0].astype(float) for t in tables)
        )

    def exchange(self, data: bytes) -> Reply:
        """One cycle."""
        self.send(data)
        return self.reply()

    def silent_for(self, seconds: float) -> bool:
        """Whether the client neither sends nor goes for so long."""
        return not select.select([self.client], [], [], seconds)[0]

    def wait_for_end(self) -> bytes:
        """What comes before the client hangs up."""
        assert self.client is not None
        data = b""
        while more := self.client.recv(65536):
            data += more
        return data

    def hang_up(self) -> None:
        if self.client is not None:
            self.client.close()
            self.client = None

    def close(self) -> None:
        self.hang_up()
        self._listener.close()


def hire(path: str, **more: object) -> Line:
    """The process of LoLA and the line to it, as the backend has it."""
    return Line(*hired(Told(socket=path, **more)))  # type: ignore[arg-type]


def wait_for(line: Line, what, timeout_s: float = PATIENCE_S) -> LolaStatus:
    """The status, once something holds of it."""
    clock = select.poll()
    for _ in range(round(timeout_s / 0.005)):
        status = line.status()
        if what(status):
            return status
        clock.poll(5)
    raise AssertionError(status)


CLIENT = """
import sys
from hal.lola.line import Line
from hal.lola.spawn import hired
from hal.lola.told import Told
from hal.lola.channel import LookWish
import time
line = Line(*hired(Told(socket=sys.argv[1], sit_after_s=float(sys.argv[2]))))
status = line.first_status(10.0)
print("ready" if status.connected else status.refusal, flush=True)
while True:
    line.send(LookWish(1.5, 0.0, 0.5, time.monotonic_ns() + 5_000_000_000))
    line.status()
    time.sleep(0.02)
"""


class Client:
    """A daemon's worth of client in a process of its own: it turns the head for ever."""

    def __init__(self, path: str, sit_after_s: float) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-c", CLIENT, path, str(sit_after_s)],
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ},
        )

    def wait_ready(self) -> None:
        assert self.process.stdout is not None
        assert self.process.stdout.readline() == "ready\n"

    def signal(self, number: signal.Signals) -> None:
        self.process.send_signal(number)
        if number == signal.SIGKILL:
            self.process.wait()

    def close(self) -> None:
        self.process.send_signal(signal.SIGCONT)
        self.process.kill()
        self.process.wait()
        assert self.process.stdout is not None
        self.process.stdout.close()
