"""Everybody sees the same frames in turns, timed and scored at once."""

from __future__ import annotations

import statistics
from collections.abc import Callable

from naod.bench.frames import Sequence
from naod.bench.peers.peer import CONTESTANTS, Peer, Seen, make_peer
from naod.bench.score import Score, Summary, score, summary
from naod.bench.timing import interleaved
from naod.geometry.camera import PinholeCamera, nominal_camera

MEMCPY = "memcpy of a frame"

Progress = Callable[[str], None]


class Contestant:
    """A peer that keeps what it saw, so that one run both times and scores it."""

    def __init__(self, peer: Peer, sequence: Sequence) -> None:
        self._peer, self._sequence = peer, sequence
        self.seen: dict[int, Seen] = {}
        # trackers start where the object was shown: the sequence goes on from there
        peer.learn(sequence.shown, sequence.region)

    def __call__(self, number: int) -> None:
        """See one of the frames."""
        frame = self._sequence.frames[number]
        self.seen[number] = self._peer.segment(frame.yuyv, frame.motion_px)

    def scores(self, camera: PinholeCamera) -> list[Score]:
        """Of everything seen, in order."""
        frames, shape = self._sequence.frames, self._sequence.shape
        return [score(frames[n], self.seen[n], shape, camera) for n in sorted(self.seen)]


class Contest:
    """What every sequence said about every method; those of one name belong together."""

    def __init__(self) -> None:
        self._scores: dict[tuple[str, str], list[Score]] = {}
        self._medians_ms: dict[str, list[float]] = {}
        self.missing: dict[str, str] = {}

    def add(self, sequence: Sequence, progress: Progress) -> None:
        """Let everybody who is installed see the sequence, in turns."""
        height, width = sequence.shown.shape[:2]
        camera = nominal_camera("v6", width, height)
        contestants: dict[str, Contestant] = {}
        for name in CONTESTANTS:
            try:
                peer = make_peer(name, (width, height), sequence.shape)
                contestants[name] = Contestant(peer, sequence)
            except ImportError as error:
                self.missing[name] = f"not installed: {error.name}"
        progress(f"{sequence.name}: {len(contestants)} methods")
        copies: dict[str, Callable[[int], object]] = {
            MEMCPY: lambda number: sequence.frames[number].yuyv.copy()
        }
        rounds = len(sequence.frames)
        timings = interleaved({**copies, **contestants}, MEMCPY, rounds, warm_up=1)
        for timing in timings if sequence.shape is not None else ():
            self._medians_ms.setdefault(timing.name, []).append(timing.median_ms)
        for name, contestant in contestants.items():
            scores = self._scores.setdefault((name, sequence.name), [])
            scores += contestant.scores(camera)

    def summary(self, name: str, sequence: str) -> Summary:
        """Of a method on all sequences of that name."""
        return summary(self._scores[name, sequence])

    def median_ms(self, name: str) -> float:
        """Over the rendered sequences, which have one size."""
        return statistics.median(self._medians_ms[name])
