"""`naod bench perception`: ours and what users could pick instead, on the same pictures."""

from __future__ import annotations

import statistics
from collections.abc import Callable

import cv2
import msgspec

from naod.bench.frames import Sequence, Walk, WalkSettings
from naod.bench.peers.peer import PEERS, Peer, Seen, make_peer
from naod.bench.score import LOST_BELOW, Score, Summary, score, summary
from naod.bench.table import Report
from naod.bench.timing import interleaved
from naod.geometry.camera import PinholeCamera, nominal_camera
from naod.pose.objects import Cylinder

EXPOSURES_S = (0.0, 0.010, 0.033)
ABSENT = "absent"
MEMCPY = "memcpy of a frame"
OURS = next(iter(PEERS))
ABSENT_SHARE = 3
"""Pictures without the object: one for this many with it."""

Progress = Callable[[str], None]


def run(progress: Progress, settings: WalkSettings | None = None) -> Report:
    """Every peer on every picture, one thread, taking turns."""
    settings = settings or WalkSettings()
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        return _report(_sequences(settings, progress), settings, progress)
    finally:
        cv2.setNumThreads(threads)


def _sequences(settings: WalkSettings, progress: Progress) -> list[Sequence]:
    walk = Walk(settings)
    taken = []
    for exposure in EXPOSURES_S:
        name = f"{1e3 * exposure:.0f} ms"
        progress(f"rendering at {name}")
        taken.append(walk.taken(name, exposure))
    progress("rendering without the object")
    fewer = msgspec.structs.replace(settings, count=-(-settings.count // ABSENT_SHARE))
    return [*taken, Walk(fewer).without(ABSENT, EXPOSURES_S[-1])]


class _Contestant:
    """A peer that keeps what it saw, so that one run both times and scores it."""

    def __init__(self, peer: Peer, sequence: Sequence) -> None:
        self._peer, self.frames = peer, sequence.frames
        self.seen: dict[int, Seen] = {}
        # trackers start where the object was shown: the sequence goes on from there
        peer.learn(sequence.shown, sequence.region)

    def __call__(self, number: int) -> None:
        frame = self.frames[number]
        self.seen[number] = self._peer.segment(frame.yuyv, frame.motion_px)

    def scores(self, camera: PinholeCamera) -> list[Score]:
        """Of everything seen, in order."""
        pairs = [(self.frames[number], self.seen[number]) for number in sorted(self.seen)]
        return [score(frame, seen, Cylinder(), camera) for frame, seen in pairs]


class _Tally:
    """What every sequence said about every peer."""

    def __init__(self, size: tuple[int, int]) -> None:
        self.size = size
        self.camera = nominal_camera("v6", *size)
        self.summaries: dict[str, dict[str, Summary]] = {}
        self.medians_ms: dict[str, list[float]] = {}
        self.missing: dict[str, str] = {}

    def add(self, sequence: Sequence, progress: Progress) -> None:
        """Let everybody who is installed see the sequence, in turns."""
        contestants: dict[str, _Contestant] = {}
        for name in PEERS:
            try:
                contestants[name] = _Contestant(make_peer(name, self.size), sequence)
            except ImportError as error:
                self.missing[name] = f"not installed: {error.name}"
        progress(f"{sequence.name}: {len(contestants)} methods")
        copies: dict[str, Callable[[int], object]] = {
            MEMCPY: lambda number: sequence.frames[number].yuyv.copy()
        }
        timings = interleaved({**copies, **contestants}, OURS, len(sequence.frames), warm_up=1)
        for timing in timings:
            self.medians_ms.setdefault(timing.name, []).append(timing.median_ms)
        for name, contestant in contestants.items():
            said = summary(contestant.scores(self.camera))
            self.summaries.setdefault(name, {})[sequence.name] = said
        progress(sequence.name)

    def median_ms(self, name: str) -> float:
        """Over the sequences."""
        return statistics.median(self.medians_ms[name])


def _report(sequences: list[Sequence], settings: WalkSettings, progress: Progress) -> Report:
    tally = _Tally(settings.size)
    for sequence in sequences:
        tally.add(sequence, progress)
    blurs = [sequence.name for sequence in sequences if sequence.name != ABSENT]
    columns = ["method", "ms", "times ours"]
    for what in ("box IoU", "mask IoU", "lost %", "distance %"):
        columns += [f"{what} {blur}" for blur in blurs]
    rows = [_row(name, tally, blurs) for name in PEERS]
    memcpy_ms = tally.median_ms(MEMCPY)
    empty = (None,) * (len(columns) - 3)
    rows.append((MEMCPY, memcpy_ms, memcpy_ms / tally.median_ms(OURS), *empty, None))
    width, height = settings.size
    notes = (
        f"{len(sequences[0].frames)} rendered frames of {width}x{height} per exposure; medians, a "
        f"lost frame counting 0; lost: nothing found, or box IoU below {LOST_BELOW}",
        "distance: median error of the pose that follows from the mask alone; one thread",
    )
    return Report("perception", (*columns, "found absent %"), tuple(rows), notes)


Row = tuple[str | float | int | None, ...]


def _row(name: str, tally: _Tally, blurs: list[str]) -> Row:
    if name not in tally.summaries:
        return (f"{name} ({tally.missing[name]})", *(None,) * (3 + 4 * len(blurs)))
    said = tally.summaries[name]
    ms = tally.median_ms(name)
    return (
        name,
        ms,
        ms / tally.median_ms(OURS),
        *(said[blur].box_iou for blur in blurs),
        *(said[blur].mask_iou for blur in blurs),
        *(_percent(said[blur].lost) for blur in blurs),
        *(_percent(said[blur].distance_error) for blur in blurs),
        _percent(said[ABSENT].found_absent),
    )


def _percent(share: float | None) -> float | None:
    return None if share is None else 100.0 * share
