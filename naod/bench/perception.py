"""`naod bench perception`: ours and what users could pick instead, on the same pictures."""

from __future__ import annotations

import statistics
from collections.abc import Callable

import cv2
import msgspec

from naod.bench.frames import Sequence, Walk, WalkSettings
from naod.bench.peers.peer import PEERS, Peer, Seen, make_peer
from naod.bench.real import FOLDER_VARIABLE, real_sequences
from naod.bench.score import LOST_BELOW, Score, Summary, score, summary
from naod.bench.table import Report
from naod.bench.timing import interleaved
from naod.geometry.camera import PinholeCamera, nominal_camera
from naod.pose.objects import Cylinder

EXPOSURES_S = (0.0, 0.010, 0.033)
ABSENT = "absent"
MEMCPY = "memcpy of a frame"
OURS = next(iter(PEERS))
WIDTHS, GROWTH_FRAMES = (160, 320), 8
ABSENT_SHARE = 3
"""Pictures without the object: one for this many with it."""

Progress = Callable[[str], None]


def run(progress: Progress, settings: WalkSettings | None = None) -> Report:
    """Every peer on every picture, one thread, taking turns."""
    settings = settings or WalkSettings()
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        sequences = _sequences(settings, progress)
        tally = _Tally()
        for sequence in [*sequences, *real_sequences()]:
            tally.add(sequence, progress)
        grown = {width: _at_width(width, settings, progress) for width in WIDTHS}
        return _report(tally, grown, settings)
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

    def __init__(self) -> None:
        self.summaries: dict[str, dict[str, Summary]] = {}
        self.medians_ms: dict[str, list[float]] = {}
        self.missing: dict[str, str] = {}

    def add(self, sequence: Sequence, progress: Progress) -> None:
        """Let everybody who is installed see the sequence, in turns."""
        height, width = sequence.shown.shape[:2]
        size = (width, height)
        camera = nominal_camera("v6", *size)
        contestants: dict[str, _Contestant] = {}
        for name in PEERS:
            try:
                contestants[name] = _Contestant(make_peer(name, size), sequence)
            except ImportError as error:
                self.missing[name] = f"not installed: {error.name}"
        progress(f"{sequence.name}: {len(contestants)} methods")
        copies: dict[str, Callable[[int], object]] = {
            MEMCPY: lambda number: sequence.frames[number].yuyv.copy()
        }
        timings = interleaved({**copies, **contestants}, OURS, len(sequence.frames), warm_up=1)
        rendered = sequence.frames[0].T_camera_object is not None or sequence.name == ABSENT
        for timing in timings if rendered else ():
            self.medians_ms.setdefault(timing.name, []).append(timing.median_ms)
        for name, contestant in contestants.items():
            said = summary(contestant.scores(camera))
            self.summaries.setdefault(name, {})[sequence.name] = said
        progress(sequence.name)

    def median_ms(self, name: str) -> float:
        """Over the sequences."""
        return statistics.median(self.medians_ms[name])


def _at_width(width: int, settings: WalkSettings, progress: Progress) -> _Tally:
    """A few sharp pictures of another size, for the time alone."""
    size = (width, width * 3 // 4)
    small = msgspec.structs.replace(settings, size=size, count=min(settings.count, GROWTH_FRAMES))
    tally = _Tally()
    tally.add(Walk(small).taken(f"{width} wide", 0.0), progress)
    return tally


def _report(tally: _Tally, grown: dict[int, _Tally], settings: WalkSettings) -> Report:
    blurs = [f"{1e3 * exposure:.0f} ms" for exposure in EXPOSURES_S]
    real = [name for name in tally.summaries[OURS] if name not in (*blurs, ABSENT)]
    columns = ["method", "ms", "times ours"]
    for what in ("box IoU", "mask IoU", "lost %", "distance %"):
        columns += [f"{what} {blur}" for blur in blurs]
    columns += ["found absent %", *(f"mask IoU {name}" for name in real)]
    columns += [f"ms at {width}" for width in grown]
    rows = [_row(name, tally, blurs, real, grown) for name in PEERS]
    memcpy_ms = tally.median_ms(MEMCPY)
    empty = (None,) * (len(columns) - 3 - len(grown))
    small_ms = [other.median_ms(MEMCPY) for other in grown.values()]
    rows.append((MEMCPY, memcpy_ms, memcpy_ms / tally.median_ms(OURS), *empty, *small_ms))
    width, height = settings.size
    notes: tuple[str, ...] = (
        f"{settings.count} rendered frames of {width}x{height} per exposure; medians, a "
        f"lost frame counting 0; lost: nothing found, or box IoU below {LOST_BELOW}",
        "distance: median error of the pose that follows from the mask alone; one thread",
    )
    if not real:
        notes = (*notes, f"no photographs: {FOLDER_VARIABLE} names the folder they are in")
    return Report("perception", tuple(columns), tuple(rows), notes)


Row = tuple[str | float | int | None, ...]


def _row(
    name: str, tally: _Tally, blurs: list[str], real: list[str], grown: dict[int, _Tally]
) -> Row:
    if name not in tally.summaries:
        cells = 3 + 4 * len(blurs) + len(real) + len(grown)
        return (f"{name} ({tally.missing[name]})", *(None,) * cells)
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
        *(said[photographs].mask_iou for photographs in real),
        *(other.median_ms(name) for other in grown.values()),
    )


def _percent(share: float | None) -> float | None:
    return None if share is None else 100.0 * share
