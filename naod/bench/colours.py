"""`naod bench colours`: colour models on rendered walks, at home and in rooms never seen."""

from __future__ import annotations

import statistics
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Protocol

import msgspec
import numpy as np
from numpy.typing import NDArray

from naod.bench.peers.hsv import HsvThreshold
from naod.bench.rendered_walks import RoomLook, Things, WalkFrame, Walks
from naod.bench.score import LOST_BELOW, polygon_iou
from naod.bench.table import Report
from naod.config import SegmentationConfig
from naod.perception.blob import find_blob
from naod.perception.colour_model import Region
from naod.perception.learning import KINDS, ModelKind, learn_model
from naod.perception.segmenter import Segmenter

Progress = Callable[[str], None]
Corners = NDArray[np.float64]

EXPOSURES_S = (0.0, 0.010, 0.033)
HOME = "home"
ROOMS: Mapping[str, RoomLook] = {
    HOME: RoomLook(),
    "unseen, light 0.7": RoomLook(seed=7, light=0.7),
    "unseen, light 1.3": RoomLook(seed=8, light=1.3),
    "other walls, light 0.7": RoomLook(seed=9, light=0.7, picture=True),
    "other walls, light 1.3": RoomLook(seed=10, light=1.3, picture=True),
    "object absent": RoomLook(seed=3, absent=True),
}
SHOWN_FRAMES = 3


class Finder(Protocol):
    """Finds the object's box (4, 2) in a YUYV picture, or None."""

    def __call__(self, yuyv: NDArray[np.uint8]) -> Corners | None:
        """The box in pixels."""
        ...


class Tally(msgspec.Struct, frozen=True):
    """Over the frames of a walk. `box_iou`: median, a lost frame counting 0; None when absent.

    `lost`: share of frames with the object whose box misses it; `false_finds`: share of frames
    without it in which something was found.
    """

    box_iou: float | None
    lost: float | None
    false_finds: float | None


def run(
    progress: Progress,
    size: tuple[int, int] = (640, 480),
    count: int = 20,
    rooms: Mapping[str, RoomLook] = ROOMS,
    things: Sequence[Things] = ("can", "board"),
) -> Report:
    """Everything is learnt from the first of the rooms and tried in all of them."""
    rows: list[tuple[str | float | int | None, ...]] = []
    with tempfile.TemporaryDirectory() as folder:
        for thing in things:
            shown = Walks(thing, next(iter(rooms.values())), Path(folder), size).shown(SHOWN_FRAMES)
            finders = finders_of(*shown)
            for name, look in rooms.items():
                progress(f"{thing}, {name}")
                walks = Walks(thing, look, Path(folder), size)
                taken = [walks.frames(count, exposure) for exposure in EXPOSURES_S]
                for who, find in finders.items():
                    tallies = [tally(find, frames) for frames in taken]
                    rows.append((f"{thing}, {name}", who, *_figures(tallies)))
    columns = ["walk", "model"]
    for exposure in EXPOSURES_S:
        columns += [f"IoU {1e3 * exposure:.0f} ms", "lost", "false"]
    return Report("colours", tuple(columns), tuple(rows))


def finders_of(frames: list[NDArray[np.uint8]], region: Region) -> dict[str, Finder]:
    """Our kinds of model and an HSV threshold, each learnt from the same marked frames."""
    height, width = frames[0].shape[:2]
    finders: dict[str, Finder] = {
        kind: _ours(frames, region, kind, (width, height)) for kind in KINDS
    }
    threshold = HsvThreshold()
    threshold.learn(frames[0], region)
    finders["HSV threshold"] = lambda yuyv: threshold.segment(yuyv).corners_px
    return finders


def tally(find: Finder, frames: Sequence[WalkFrame]) -> Tally:
    """What a finder makes of frames; those that cut the object off do not count."""
    overlaps: list[float] = []
    false_finds: list[bool] = []
    for frame in frames:
        if frame.cut_off:
            continue
        found = find(frame.yuyv)
        if frame.corners_px is None:
            false_finds.append(found is not None)
        else:
            overlaps.append(0.0 if found is None else polygon_iou(found, frame.corners_px))
    return Tally(
        box_iou=statistics.median(overlaps) if overlaps else None,
        lost=float(np.mean([o < LOST_BELOW for o in overlaps])) if overlaps else None,
        false_finds=float(np.mean(false_finds)) if false_finds else None,
    )


def _ours(
    frames: list[NDArray[np.uint8]], region: Region, kind: ModelKind, size: tuple[int, int]
) -> Finder:
    segmenter = Segmenter(learn_model(frames, region, kind), SegmentationConfig(), size)

    def find(yuyv: NDArray[np.uint8]) -> Corners | None:
        blob = find_blob(segmenter.segment(yuyv), segmenter.settings.pixels_min)
        return None if blob is None else blob.corners_px

    return find


def _figures(tallies: Sequence[Tally]) -> list[float | None]:
    return [x for one in tallies for x in (one.box_iou, one.lost, one.false_finds)]
