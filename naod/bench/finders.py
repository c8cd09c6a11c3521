"""Who looks for the object in the benchmark of rooms: each model of ours, and a threshold."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol

from naod.bench.frames import Frame, Sequence
from naod.bench.peers.hsv import HsvThreshold
from naod.bench.peers.peer import BY_EDGES, Peer, Seen, ours_of
from naod.perception.learning import KINDS

ITS_EDGES = "box by its edges"
LOOKED_FOR = 4
"""Frames with the object that may pass before it counts as not found again."""


class Finder(Protocol):
    """Looks for the object in picture after picture."""

    def __call__(self, frame: Frame) -> Seen:
        """What it sees."""
        ...

    def restart(self) -> None:
        """Forget the pictures seen so far, not the object."""
        ...


class PeerFinder:
    """A peer that has been taught, as a finder."""

    def __init__(self, peer: Peer, taught: Sequence) -> None:
        self._peer, self._taught = peer, taught
        self.restart()

    def __call__(self, frame: Frame) -> Seen:
        """The peer's answer."""
        return self._peer.segment(frame.yuyv, frame.motion_px)

    def restart(self) -> None:
        """Taught again: nothing else resets somebody else's tracker."""
        self._peer.learn(self._taught.shown, self._taught.region)


def finders_of(taught: Sequence) -> dict[str, Finder]:
    """Our kinds of model, its box by edges, and an HSV threshold, taught by one marked frame."""
    height, width = taught.shown.shape[:2]
    variants = {kind: kind for kind in KINDS} | {ITS_EDGES: BY_EDGES}
    finders: dict[str, Finder] = {
        name: PeerFinder(ours_of(variant, (width, height), taught.shape), taught)
        for name, variant in variants.items()
    }
    finders["HSV threshold"] = PeerFinder(HsvThreshold(), taught)
    return finders


def seen_again(find: Finder, before: Iterable[Frame], after: Iterable[Frame]) -> int | None:
    """Frames with the object it takes until it is found after it was gone; None if too many."""
    find.restart()
    for frame in before:
        find(frame)
    for number, frame in enumerate(after, start=1):
        if find(frame).corners_px is not None:
            return number
        if number == LOOKED_FOR:
            break
    return None
