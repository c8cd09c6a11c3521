"""`naod bench perception`: ours and what users could pick instead, on the same pictures."""

from __future__ import annotations

from collections.abc import Callable

import cv2
import msgspec

from naod.bench import growth, optima, photographs, poses, ratios
from naod.bench.contest import MEMCPY, Contest
from naod.bench.frames import Sequence, Walk, WalkSettings
from naod.bench.peers.peer import CONTESTANTS
from naod.bench.real import FOLDER_VARIABLE, real_sequences
from naod.bench.room import UNSEEN
from naod.bench.score import LOST_BELOW
from naod.bench.table import Cell, Report

EXPOSURES_S = (0.0, 0.010, 0.033)
ABSENT = "absent"
AWAY = "other walls"
"""The room without the object is one in which it never was."""

WALKS = 3
"""Seeds of the walk at each exposure."""

Progress = Callable[[str], None]


def run(progress: Progress, settings: WalkSettings | None = None, walks: int = WALKS) -> Report:
    """Every method on every picture, one thread, taking turns."""
    settings = settings or WalkSettings()
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        rendered = rendered_sequences(settings, walks, progress)
        real = real_sequences()
        contest = Contest()
        for sequence in [*rendered, *real]:
            contest.add(sequence, progress)
        further = (
            ratios.run(rendered, progress),
            optima.run([*rendered, *real], progress),
            poses.run(progress, settings, poses.FEW_WALKS),
            growth.run(settings, progress),
            photographs.run(real, progress),
        )
        return _report(contest, settings, walks, [one.name for one in real], further)
    finally:
        cv2.setNumThreads(threads)


def rendered_sequences(settings: WalkSettings, walks: int, progress: Progress) -> list[Sequence]:
    """Walks of several seeds at each exposure, and the last room without the object."""
    taken = []
    for seed in range(settings.seed, settings.seed + walks):
        walk = Walk(msgspec.structs.replace(settings, seed=seed))
        for exposure in EXPOSURES_S:
            name = blur_name(exposure)
            progress(f"rendering walk {seed} at {name}")
            taken.append(walk.taken(name, exposure))
        progress(f"rendering walk {seed} without the object")
        away = msgspec.structs.replace(settings, seed=100 + seed, room=UNSEEN[AWAY])
        shown = taken[-len(EXPOSURES_S)]
        gone = Walk(away).without(ABSENT, EXPOSURES_S[-1])
        taken.append(Sequence(ABSENT, shown.shown, shown.region, gone.frames, shown.shape))
    return taken


def blur_name(exposure_s: float) -> str:
    """What the columns of an exposure are called."""
    return f"{1e3 * exposure_s:.0f} ms"


def _report(
    contest: Contest,
    settings: WalkSettings,
    walks: int,
    real: list[str],
    further: tuple[Report, ...],
) -> Report:
    blurs = [blur_name(exposure) for exposure in EXPOSURES_S]
    columns = ["method", "ms", "times memcpy"]
    for what in ("box IoU", "mask IoU", "lost %", "width %", "distance %"):
        columns += [f"{what} {blur}" for blur in blurs]
    columns += ["found absent %", *(f"mask IoU {name}" for name in real)]
    rows = [_row(name, contest, blurs, real) for name in CONTESTANTS]
    memcpy_ms = contest.median_ms(MEMCPY)
    rows.append((MEMCPY, memcpy_ms, 1.0, *(None,) * (len(columns) - 3)))
    width, height = settings.size
    notes: tuple[str, ...] = (
        f"{walks} walks of {settings.count} rendered frames of {width}x{height} per exposure; "
        f"medians, a lost frame counting 0; lost: nothing found, or box IoU below {LOST_BELOW}",
        "width, distance: median error of the box's width, and of the pose that follows from the "
        "mask alone; absent: in a room where the object never was; one thread",
    )
    if not real:
        notes = (*notes, f"no photographs: {FOLDER_VARIABLE} names the folder they are in")
    return Report("perception", tuple(columns), tuple(rows), notes, further)


def _row(name: str, contest: Contest, blurs: list[str], real: list[str]) -> tuple[Cell, ...]:
    if name in contest.missing:
        cells = 3 + 5 * len(blurs) + len(real)
        return (f"{name} ({contest.missing[name]})", *(None,) * cells)
    said = {sequence: contest.summary(name, sequence) for sequence in (*blurs, ABSENT, *real)}
    ms = contest.median_ms(name)
    return (
        name,
        ms,
        ms / contest.median_ms(MEMCPY),
        *(said[blur].box_iou for blur in blurs),
        *(said[blur].mask_iou for blur in blurs),
        *(_percent(said[blur].lost) for blur in blurs),
        *(_percent(said[blur].width_error) for blur in blurs),
        *(_percent(said[blur].distance_error) for blur in blurs),
        _percent(said[ABSENT].found_absent),
        *(said[photographs].mask_iou for photographs in real),
    )


def _percent(share: float | None) -> float | None:
    return None if share is None else 100.0 * share
