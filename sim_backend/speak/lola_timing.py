"""Measuring how soon LoLA's messages are answered, by the backend's process or by a thread here.

The answer's time is taken where it is sent, so how late the metronome itself wakes up is not
counted; how late the message was read is.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import threading
import time
from contextlib import suppress
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hal.errors import BackendError, MotionRefusedError
from hal.lola.channel import LeaveWish, LookWish
from hal.lola.layout import PERIOD_S
from hal.lola.line import Line
from hal.lola.process import Server
from hal.lola.shared import Shared, create
from hal.lola.spawn import hired
from hal.lola.told import Told
from hal.timing import LoopTiming
from sim_backend.speak.lola_metronome import PERIOD_NS

SPARE_SLOTS = 64
LOOK_EVERY_S = 0.066
FIRST_TICKS = 20
"""Not counted: connecting, and the first call of everything."""


def measure(seconds: float, in_process: bool, real_time: bool) -> LoopTiming:
    """Answer messages for so long, the head being turned 15 times a second as the daemon does.

    `in_process`: by a thread of this process, beside whatever else it does. Raises BackendError.
    """
    count = FIRST_TICKS + max(1, round(seconds * 1e9 / PERIOD_NS))
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "robocup")
        metronome = subprocess.Popen(
            [sys.executable, "-m", "sim_backend.speak.lola_metronome", path, str(count)],
            stdout=subprocess.PIPE,
            text=True,
        )
        assert metronome.stdout is not None
        with metronome.stdout as stdout:
            if stdout.readline() != "listening\n":
                raise BackendError("the metronome did not start")
            told = Told(
                socket=path,
                sit_after_s=30.0,
                slots=count + SPARE_SLOTS,
                real_time=real_time,
                quiet=True,
            )
            line, shared, server = _opened(told, in_process)
            _turn_the_head(line, metronome)
            sent = np.array(stdout.read().split(), dtype=np.int64)
        granted = line.status().real_time
        _closed(line, server)
    return LoopTiming(_delays(shared, sent)[FIRST_TICKS:], PERIOD_S, granted)


def _opened(told: Told, in_process: bool) -> tuple[Line, Shared, threading.Thread | None]:
    thread = None
    if in_process:
        memory, fd = create(told.slots)
        server = Server(told, memory, fd, real_time=False)
        thread = threading.Thread(target=server.run, name="lola", daemon=True)
        thread.start()
    link, shared = hired(told)
    return Line(link, shared), shared, thread


def _turn_the_head(line: Line, metronome: subprocess.Popen[str]) -> None:
    number = 0
    while metronome.poll() is None:
        number += 1
        yaw = 0.5 if number % 30 < 15 else -0.5
        with suppress(MotionRefusedError):
            line.send(LookWish(yaw, 0.0, 1.0, time.monotonic_ns() + 1_000_000_000))
        line.status()
        time.sleep(LOOK_EVERY_S)


def _closed(line: Line, server: threading.Thread | None) -> None:
    # the metronome has gone, so there is nobody to sit down for
    with suppress(MotionRefusedError):
        line.send(LeaveWish())
    line.close(5.0)
    if server is not None:
        server.join(timeout=5.0)


def _delays(shared: Shared, sent_ns: NDArray[np.int64]) -> NDArray[np.float64]:
    """From sending to answering, s, (n,); infinite where there was no answer."""
    delays = np.full(len(sent_ns), np.inf)
    for number in range(shared.count):
        found = shared.answer(number)
        if found is not None:
            carried, answered_ns = round(found[0].battery), found[1]
            delays[carried] = (answered_ns - int(sent_ns[carried])) / 1e9
    return delays
