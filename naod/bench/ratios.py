"""How many times as long as a copy of the frame, and how many times quicker than the others."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from naod.bench.frames import Frame
from naod.bench.frames import Sequence as Taken
from naod.bench.peers.camshift import CamShift
from naod.bench.peers.hsv import HsvThreshold
from naod.bench.peers.peer import Peer
from naod.bench.table import Report
from naod.bench.timing import interleaved
from naod.config import SegmentationConfig
from naod.finding.find import find_object
from naod.finding.hue import Colours
from naod.geometry.camera import nominal_camera
from naod.perception.blob import find_blob
from naod.perception.learning import learn_model
from naod.perception.segmenter import Segmenter
from naod.pose.locate import locate

MEMCPY, BOX, POSE = "memcpy of the frame", "naod: frame to box", "naod: frame to exact pose"
OBJECT = "naod: frame to object, by shape and size"
GRABCUT = "GrabCut, 3 iterations, whole frame"
FRAMES_MIN = 60
"""More frames than a cache holds go round, as a camera's are new every time."""

GRABCUT_ROUNDS = 6

Progress = Callable[[str], None]
Work = Callable[[int], object]


def run(sequences: Sequence[Taken], progress: Progress) -> Report:
    """Everybody's time on the rendered frames that show the object, in turns."""
    progress("ratios")
    seen = [one for one in sequences if one.frames[0].mask is not None]
    frames = [frame for one in seen for frame in one.frames if frame.mask is not None]
    yuyvs = [frame.yuyv for frame in frames]
    rounds = max(len(frames), FRAMES_MIN)
    timings = interleaved(_contestants(seen[0], frames, yuyvs), BOX, rounds)
    timings += interleaved(_grabcut(seen[0], frames), GRABCUT, GRABCUT_ROUNDS)
    copy_ms, box_ms = (next(t.median_ms for t in timings if t.name == n) for n in (MEMCPY, BOX))
    rows = tuple(
        (t.name, t.median_ms, t.median_ms / copy_ms, t.median_ms / box_ms) for t in timings
    )
    notes = (f"medians of {rounds} frames, GrabCut's of {GRABCUT_ROUNDS}; one thread",)
    columns = ("work", "ms", "times memcpy", "times naod's box")
    return Report("ratios", columns, rows, notes)


def _contestants(
    taught: Taken, frames: list[Frame], yuyvs: list[NDArray[np.uint8]]
) -> dict[str, Work]:
    copy = np.empty_like(yuyvs[0])
    others: dict[str, Peer] = {"CAMShift": CamShift(), "HSV threshold, morphology": HsvThreshold()}
    for peer in others.values():
        peer.learn(taught.shown, taught.region)
    return {
        MEMCPY: lambda n: np.copyto(copy, yuyvs[n % len(yuyvs)]),
        **ours(taught, yuyvs),
        **{name: _peer(peer, frames) for name, peer in others.items()},
    }


def ours(taught: Taken, yuyvs: list[NDArray[np.uint8]]) -> dict[str, Work]:
    """From one of the frames to its box, to the object and to its pose."""
    return {
        BOX: _box(taught, yuyvs),
        OBJECT: _object(taught, yuyvs),
        POSE: _pose(taught, yuyvs),
    }


def _peer(peer: Peer, frames: list[Frame]) -> Work:
    return lambda n: peer.segment(frames[n % len(frames)].yuyv)


def _grabcut(taught: Taken, frames: list[Frame]) -> dict[str, Work]:
    from naod.bench.peers.grabcut import make_full

    height, width = taught.shown.shape[:2]
    peer = make_full((width, height))
    peer.learn(taught.shown, taught.region)
    return {GRABCUT: _peer(peer, frames)}


def _segmenter(taught: Taken) -> Segmenter:
    height, width = taught.shown.shape[:2]
    model = learn_model([taught.shown], taught.region)
    return Segmenter(model, SegmentationConfig(), (width, height))


def _box(taught: Taken, yuyvs: list[NDArray[np.uint8]]) -> Work:
    segmenter = _segmenter(taught)
    return lambda n: find_blob(segmenter.segment(yuyvs[n % len(yuyvs)]))


def _object(taught: Taken, yuyvs: list[NDArray[np.uint8]]) -> Work:
    segmenter, shape = _segmenter(taught), taught.shape
    camera = nominal_camera("v6", *segmenter.reduction.size)

    def find(n: int) -> object:
        yuyv = yuyvs[n % len(yuyvs)]
        colours = Colours(yuyv, segmenter.model)
        segmentation = segmenter.segment(yuyv)
        return find_object(segmentation, shape, camera, None, segmenter.settings, colours=colours)

    return find


def _pose(taught: Taken, yuyvs: list[NDArray[np.uint8]]) -> Work:
    """Without any knowledge of the frame before."""
    segmenter, shape = _segmenter(taught), taught.shape
    assert shape is not None
    camera = nominal_camera("v6", *segmenter.reduction.size)

    def pose(n: int) -> object:
        yuyv = yuyvs[n % len(yuyvs)]
        segmentation = segmenter.segment(yuyv)
        colours = Colours(yuyv, segmenter.model)
        found = find_object(segmentation, shape, camera, None, segmenter.settings, colours=colours)
        return None if found is None else locate(yuyv, found.blob, shape, camera)

    return pose
