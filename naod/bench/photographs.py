"""What our kinds of model make of photographs, and poses from masks against known ones."""

from __future__ import annotations

import statistics
from collections.abc import Callable

import numpy as np

from naod.bench.frames import Sequence
from naod.bench.known_poses import KnownView, chessboard, coffee_can
from naod.bench.peers.ours import Ours
from naod.bench.real import robots_walk
from naod.bench.score import score
from naod.bench.table import Cell, Report
from naod.perception.learning import KINDS, ModelKind
from naod.pose.locate import locate_mask

COLUMNS = ("photographs, model", "frames", "found", "IoU median", "worst")
POSE_COLUMNS = ("masks", "frames", "position % median", "worst", "within 95 % of sigma")
CHI2_95_OF_3 = 7.81
Progress = Callable[[str], None]


def run(sequences: list[Sequence], progress: Progress) -> Report:
    """The sequences with masks, a walk without, and the views whose poses are known."""
    progress("photographs")
    walk = robots_walk()
    rows: list[tuple[Cell, ...]] = []
    for sequence in [*sequences, *([walk] if walk else [])]:
        rows += [_row(sequence, kind) for kind in KINDS]
    views = {"coffee can": coffee_can(), "chessboard": chessboard()}
    posed = tuple(_pose_row(name, known) for name, known in views.items() if known)
    poses = Report("masks with known poses", POSE_COLUMNS, posed)
    return Report("photographs", COLUMNS, tuple(rows), further=(poses,))


def _row(sequence: Sequence, kind: ModelKind) -> tuple[Cell, ...]:
    """One kind of model on one sequence, taught by its first picture."""
    height, width = sequence.shown.shape[:2]
    ours = Ours((width, height), kind=kind)
    ours.learn(sequence.shown, sequence.region)
    seen = [ours.segment(frame.yuyv) for frame in sequence.frames]
    found = sum(one.corners_px is not None for one in seen)
    overlaps = [
        score(frame, one, None, None).mask_iou or 0.0
        for frame, one in zip(sequence.frames, seen, strict=True)
        if frame.mask is not None
    ]
    middle = statistics.median(overlaps) if overlaps else None
    worst = min(overlaps) if overlaps else None
    return (f"{sequence.name}, {kind}", len(seen), found, middle, worst)


def _pose_row(name: str, views: list[KnownView]) -> tuple[Cell, ...]:
    """Of the pose that follows from each mask; none found counts as all wrong."""
    errors, honest = [], 0
    for view in views:
        pose = locate_mask(view.mask, view.shape, view.camera)
        if pose is None:
            errors.append(100.0)
            continue
        true = view.T_camera_object[:3, 3]
        gap = pose.T_camera_object[:3, 3] - true
        errors.append(100.0 * float(np.linalg.norm(gap) / np.linalg.norm(true)))
        honest += float(gap @ np.linalg.solve(pose.covariance[:3, :3], gap)) < CHI2_95_OF_3
    share = f"{honest} of {len(views)}"
    return (name, len(views), statistics.median(errors), max(errors), share)
