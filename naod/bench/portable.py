"""`naod bench portable`: kernels as a robot gets them beside those made for this processor.

numba knows one processor at a time, so each kind has a process of its own. They take turns.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from contextlib import closing

import cv2
import msgspec

from naod.bench.frames import Walk, WalkSettings
from naod.bench.ratios import BOX, ours
from naod.bench.table import Report
from naod.bench.timing import interleaved
from naod.errors import NaodError
from naod.kernels.build import CPU, environment

EXPOSURES_S = (0.0, 0.010, 0.033)
ROUNDS = 10
TUNED, PORTABLE = "made for this processor", f"made for {CPU}"
COLUMNS = ("work", f"ms {TUNED}", f"ms {PORTABLE}", "times as long")

Progress = Callable[[str], None]
Medians = dict[str, float]


class Timer:
    """A process that times all our work whenever it is asked to, in ms."""

    def __init__(self, name: str, settings: WalkSettings, variables: Mapping[str, str]) -> None:
        self._name = name
        self._process = subprocess.Popen(
            [sys.executable, "-m", __name__, msgspec.json.encode(settings).decode()],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=dict(variables),
        )

    def close(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.communicate()

    def medians(self) -> Medians:
        """Over the frames of one round; NaodError when the process has ended."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        try:
            self._process.stdin.write(b"\n")
            self._process.stdin.flush()
            return msgspec.json.decode(self._process.stdout.readline(), type=Medians)
        except (OSError, msgspec.DecodeError) as error:
            raise NaodError(f"the process with kernels {self._name} has ended") from error


def run(
    progress: Progress,
    settings: WalkSettings | None = None,
    rounds: int = ROUNDS,
    portable: Mapping[str, str] | None = None,
) -> Report:
    """Compiles everything for the robot's processor first, which takes some minutes.

    portable: environment of the process with portable kernels, where it is another.
    """
    settings = settings or WalkSettings()
    with tempfile.TemporaryDirectory() as cache:
        there = environment(cache, CPU) if portable is None else portable
        with (
            closing(Timer(TUNED, settings, os.environ)) as here,
            closing(Timer(PORTABLE, settings, there)) as robot,
        ):
            progress("compiling")
            for timer in (here, robot):
                timer.medians()
            pairs = []
            for number in range(rounds):
                progress(f"round {number + 1} of {rounds}")
                pairs.append((here.medians(), robot.medians()))
    notes = (f"medians of {rounds} rounds in turns, of {settings.count} frames at each exposure",)
    return Report("portable", COLUMNS, tuple(_row(name, pairs) for name in pairs[0][0]), notes)


def _row(name: str, pairs: list[tuple[Medians, Medians]]) -> tuple[str, float, float, float]:
    here = statistics.median(one[name] for one, _ in pairs)
    robot = statistics.median(other[name] for _, other in pairs)
    return name, here, robot, statistics.median(b[name] / a[name] for a, b in pairs)


def main() -> None:
    """A round for every line that comes in, its medians as a line of JSON."""
    cv2.setNumThreads(1)
    walk = Walk(msgspec.json.decode(sys.argv[1], type=WalkSettings))
    taken = [walk.taken(str(exposure), exposure) for exposure in EXPOSURES_S]
    yuyvs = [frame.yuyv for one in taken for frame in one.frames]
    works = ours(taken[0], yuyvs)
    for _ in sys.stdin:
        timings = interleaved(works, BOX, len(yuyvs))
        medians = {timing.name: timing.median_ms for timing in timings}
        print(msgspec.json.encode(medians).decode(), flush=True)


if __name__ == "__main__":
    main()
