"""`naod bench rooms`: colour models at home, in rooms never seen, and learnt anew there."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Mapping

import msgspec
import numpy as np

from naod.bench.finders import Finder, finders_of, seen_again
from naod.bench.frames import Frame, Sequence, Walk, WalkSettings
from naod.bench.room import HOME, UNSEEN, Room, Thing
from naod.bench.score import LOST_BELOW, polygon_iou
from naod.bench.table import Report
from naod.perception.blob import blob_of_mask

EXPOSURES_S = (0.0, 0.010, 0.033)
ROOMS: Mapping[str, Room] = {"home": HOME, **UNSEEN}
HOME_SEED = 0
EMPTY_ROOMS = 5
"""Rooms of each kind that are walked through without the object, each furnished in another way:
what is taken for it in one picture of a room is so in many."""
EMPTY_SEEDS = 400
THINGS: tuple[Thing, ...] = ("can", "board")

Progress = Callable[[str], None]
Frames = tuple[Frame, ...]
Row = tuple[str | float | int | None, ...]


class Tally(msgspec.Struct, frozen=True):
    """Over the frames of a walk; those that cut the object off do not count.

    `box_iou`: median, a lost frame counting 0. `lost`: share of frames whose box misses the object.
    """

    frames: int
    box_iou: float
    lost: float


def run(
    progress: Progress,
    settings: WalkSettings | None = None,
    rooms: Mapping[str, Room] = ROOMS,
    things: tuple[Thing, ...] = THINGS,
    empty_rooms: int = EMPTY_ROOMS,
) -> Report:
    """Everything is learnt in the first of the rooms and tried in all of them.

    empty_rooms: how many of each kind are tried without the object.
    """
    settings = settings or WalkSettings()
    rows: list[Row] = []
    for thing in things:
        at_home = msgspec.structs.replace(settings, thing=thing, seed=HOME_SEED)
        taught = Walk(at_home).taken("home", 0.0)
        finders = finders_of(taught)
        for number, (name, room) in enumerate(rooms.items()):
            progress(f"{thing}, {name}")
            there = msgspec.structs.replace(at_home, room=room, seed=HOME_SEED + 7 * number)
            empty = _empty(there, empty_rooms)
            rows += rows_of(f"{thing}, {name}", finders, there, empty, known=number == 0)
    columns = ["walk", "model"]
    for exposure in EXPOSURES_S:
        columns += [f"box IoU {1e3 * exposure:.0f} ms", "lost %"]
    columns += ["of learnt there", "found absent %", "frames until found again"]
    notes = (
        "box IoU: median, a lost frame counting 0; learnt there: at the longest exposure",
        f"absent: {empty_rooms} rooms of each kind, at the longest exposure",
    )
    return Report("rooms", tuple(columns), tuple(rows), notes)


def rows_of(
    name: str,
    finders: Mapping[str, Finder],
    room: WalkSettings,
    empty: Frames,
    known: bool,
) -> list[Row]:
    """Everybody in one room; those who were taught elsewhere beside those taught there.

    empty: what is seen in rooms of this kind without the object.
    """
    walk = Walk(room)
    taken = [walk.taken(f"{exposure}", exposure) for exposure in EXPOSURES_S]
    native = finders if known else finders_of(taken[0])
    rows = []
    for who, find in finders.items():
        find.restart()
        tallies = [tally(find, sequence) for sequence in taken]
        here = tallies[-1] if known else tally(native[who], taken[-1])
        find.restart()
        false = [find(frame).corners_px is not None for frame in empty]
        figures = [x for t in tallies for x in (t.box_iou, 100.0 * t.lost)]
        relative = tallies[-1].box_iou / here.box_iou if here.box_iou > 0.0 else None
        again = seen_again(find, empty[: room.count], taken[-1].frames)
        rows.append((name, who, *figures, relative, 100.0 * float(np.mean(false)), again))
    return rows


def _empty(room: WalkSettings, rooms: int) -> Frames:
    """The walk through several rooms of one kind after the object was taken away, blurred."""
    seeds = [room.seed] + [EMPTY_SEEDS + 7 * n + room.seed for n in range(1, rooms)]
    walks = [Walk(msgspec.structs.replace(room, seed=seed)) for seed in seeds]
    return tuple(
        frame for walk in walks for frame in walk.without("absent", EXPOSURES_S[-1]).frames
    )


def tally(find: Finder, sequence: Sequence) -> Tally:
    """What a finder makes of a walk."""
    overlaps = [iou for frame in sequence.frames if (iou := overlap(find, frame)) is not None]
    return Tally(
        frames=len(overlaps),
        box_iou=statistics.median(overlaps) if overlaps else 0.0,
        lost=float(np.mean([iou < LOST_BELOW for iou in overlaps])) if overlaps else 0.0,
    )


def overlap(find: Finder, frame: Frame) -> float | None:
    """Box IoU in a frame, 0 when nothing is found; None if the object is not wholly in it."""
    found = find(frame)
    truth = None if frame.mask is None else blob_of_mask(frame.mask)
    if truth is None or truth.clipped:
        return None
    return 0.0 if found.corners_px is None else polygon_iou(found.corners_px, truth.corners_px)
