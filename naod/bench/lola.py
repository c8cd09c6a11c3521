"""Missed deadlines of LoLA's loop while perception keeps both cores busy.

Contestants: the backend's process, with and without real-time priority, and the same loop as a
thread of the process that perceives, which is how it is done without a process of its own. They
take turns, and each has the same load beside it: threads that see one picture after another.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from hal.backends import OpenOptions, open_robot, time_loop
from hal.timing import LoopTiming
from hal.types import BodyState, Frame, RobotInfo
from naod.bench.table import Report
from naod.config import DaemonConfig
from naod.loop.equipment import Equipment
from naod.perception.colour_model import Region
from naod.perception.learning import learn_model
from naod.pose.objects import Cylinder

THREADS = 2
ROUNDS = 3
ENVIRONMENT = "NAOD_BENCH_LOLA_S"
SECONDS = 12.0
"""Of each contestant in each round; another length by the environment variable."""

PER = 100_000
COLUMNS = (
    "LoLA's loop",
    "ticks",
    "missed",
    "per 100,000",
    "ms median",
    "ms 99.9 %",
    "ms worst",
    "pictures/s",
)
CONTESTANTS: dict[str, tuple[bool, bool]] = {
    "own process, real-time": (False, True),
    "own process": (False, False),
    "thread beside perception": (True, False),
}
"""In the process that perceives; asking for real-time priority."""


def run(progress: Callable[[str], None]) -> Report:
    """All contestants in turns, under load."""
    seconds = float(os.environ.get(ENVIRONMENT, SECONDS))
    load = Load()
    load.see()
    timings: dict[str, list[LoopTiming]] = {name: [] for name in CONTESTANTS}
    pictures = dict.fromkeys(CONTESTANTS, 0)
    for number in range(ROUNDS):
        for name, (in_process, real_time) in CONTESTANTS.items():
            progress(f"round {number + 1} of {ROUNDS}: {name}")
            with load.running() as seen:
                timing = time_loop("lola", seconds, in_process=in_process, real_time=real_time)
            pictures[name] += sum(seen)
            if timing.real_time == real_time:
                timings[name].append(timing)
    rows = tuple(
        _row(name, found, pictures[name] / (ROUNDS * seconds)) for name, found in timings.items()
    )
    cores = len(os.sched_getaffinity(0))
    notes = [
        f"{THREADS} threads of perception on {cores} cores; {ROUNDS} turns of {seconds:g} s each",
        "missed: not answered within 12 ms of being sent; never answered counts as missed",
        "pictures/s: of all threads, the same work for everybody",
    ]
    if not timings["own process, real-time"]:
        notes.append("real-time priority was not granted here (RLIMIT_RTPRIO)")
    return Report("lola", COLUMNS, rows, tuple(notes))


class Load:
    """Perception of one rendered picture, over and over."""

    def __init__(self) -> None:
        self._frame, body, region = _picture()
        self._body = body
        info = RobotInfo("nao", "v6", "lola", simulated=False)
        self._model = learn_model([self._frame.yuyv], region)
        self._equipment = [
            Equipment.from_config(DaemonConfig(), info, Cylinder()) for _ in range(THREADS)
        ]

    def see(self) -> None:
        """Once, so that everything is compiled. The picture must be seen, or it is no load."""
        sighting = self._equipment[0].sight(self._model, self._frame, self._body)
        assert sighting is not None
        assert sighting.pose is not None

    @contextmanager
    def running(self) -> Iterator[list[int]]:
        """Threads at work, and how many pictures each has seen."""
        stop, seen = threading.Event(), [0] * THREADS

        def work(number: int) -> None:
            while not stop.is_set():
                self._equipment[number].sight(self._model, self._frame, self._body)
                seen[number] += 1

        threads = [threading.Thread(target=work, args=(n,)) for n in range(THREADS)]
        for thread in threads:
            thread.start()
        try:
            yield seen
        finally:
            stop.set()
            for thread in threads:
                thread.join()


_SIM = OpenOptions(section={"scenario": None, "scenario_folder": Path(), "seed": 0})


def _picture() -> tuple[Frame, BodyState, Region]:
    """What the simulated robot sees at first, its body then, and a part of the red can."""
    robot = open_robot("sim", _SIM)
    try:
        frame = robot.camera.next(1.0)
        body = robot.body.at(frame.stamp_ns)
    finally:
        robot.close()
    assert body is not None
    rows, pairs = np.nonzero(frame.yuyv[:, 1::2, 1] > 180)
    left, right = 2 * int(pairs.min()) + 6, 2 * int(pairs.max()) - 6
    top, bottom = int(rows.min()) + 8, int(rows.max()) - 8
    return frame, body, Region(left, top, right - left, bottom - top)


def _row(
    name: str, timings: list[LoopTiming], pictures_s: float
) -> tuple[str | float | int | None, ...]:
    if not timings:
        return (name, 0, None, None, None, None, None, None)
    delays = np.concatenate([timing.answered_s for timing in timings])
    missed = sum(timing.missed for timing in timings)
    median, most = np.percentile(delays, 50), np.percentile(delays, 99.9, method="higher")
    return (
        name,
        len(delays),
        missed,
        PER * missed / len(delays),
        1e3 * float(median),
        1e3 * float(most),
        1e3 * float(delays.max()),
        pictures_s,
    )
