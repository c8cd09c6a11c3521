"""How good an answer is: overlap of boxes and of masks, distance, what was lost."""

from __future__ import annotations

import statistics

import cv2
import msgspec
import numpy as np
from numpy.typing import NDArray

from naod.bench.frames import Frame
from naod.bench.peers.peer import Seen
from naod.geometry.camera import PinholeCamera
from naod.perception.blob import blob_of_mask, ordered_corners
from naod.pose.locate import locate_mask
from naod.pose.objects import ObjectShape

LOST_BELOW = 0.1
"""Box IoU below which whatever was found is something else."""


class Score(msgspec.Struct, frozen=True):
    """Of one picture. None where there is nothing to compare with, or nothing found.

    `there`: the object was. `width_error`: relative, of the box. `distance_error`: relative, of the
    pose that follows from the mask.
    """

    there: bool
    found: bool
    box_iou: float | None = None
    mask_iou: float | None = None
    width_error: float | None = None
    distance_error: float | None = None


class Summary(msgspec.Struct, frozen=True):
    """Of a sequence: medians over pictures with the object, a lost one counting 0; shares."""

    frames: int
    box_iou: float | None
    mask_iou: float | None
    lost: float | None
    width_error: float | None
    distance_error: float | None
    posed: float | None
    found_absent: float | None


def score(
    frame: Frame, seen: Seen, shape: ObjectShape | None, camera: PinholeCamera | None
) -> Score:
    """One picture's. No pose where shape, camera or truth are missing."""
    found = seen.corners_px is not None
    if frame.mask is None:
        return Score(there=False, found=found)
    mask = main_region(seen, frame.mask.shape)
    truth = blob_of_mask(frame.mask)
    corners = seen.corners_px
    box, width = 0.0, None
    if corners is not None and truth is not None:
        box = polygon_iou(corners, truth.corners_px)
        seen_px = width_px(ordered_corners(corners))
        width = abs(seen_px / width_px(truth.corners_px) - 1.0)
    distance = None
    if found and shape is not None and camera is not None and frame.T_camera_object is not None:
        pose = locate_mask(mask, shape, camera)
        if pose is not None:
            true_m = float(np.linalg.norm(frame.T_camera_object[:3, 3]))
            distance = abs(float(np.linalg.norm(pose.T_camera_object[:3, 3])) / true_m - 1.0)
    return Score(True, found, box, mask_iou(mask, frame.mask), width, distance)


def summary(scores: list[Score]) -> Summary:
    """Medians and shares; None where no picture could say."""
    there = [s for s in scores if s.there]
    absent = [s for s in scores if not s.there]
    errors = [s.distance_error for s in there if s.distance_error is not None]
    widths = [s.width_error for s in there if s.width_error is not None]
    return Summary(
        frames=len(scores),
        box_iou=_median([s.box_iou or 0.0 for s in there]),
        mask_iou=_median([s.mask_iou or 0.0 for s in there]),
        lost=_share([(s.box_iou or 0.0) < LOST_BELOW for s in there]),
        width_error=_median(widths),
        distance_error=_median(errors),
        posed=_share([s.distance_error is not None for s in there]),
        found_absent=_share([s.found for s in absent]),
    )


def full_size(seen: Seen, shape: tuple[int, ...]) -> NDArray[np.uint8]:
    """The mask at the picture's size (H, W), each mask pixel a block, the rest empty."""
    grain = round(seen.grain_px)
    if grain == 1:
        return seen.mask
    large = np.repeat(np.repeat(seen.mask, grain, axis=0), grain, axis=1)
    large = large[: shape[0], : shape[1]]
    rest = (shape[0] - large.shape[0], shape[1] - large.shape[1])
    return np.pad(large, ((0, rest[0]), (0, rest[1])))


def main_region(seen: Seen, shape: tuple[int, ...]) -> NDArray[np.uint8]:
    """The region of touching pixels that fills the box most, at the picture's size (H, W)."""
    mask = full_size(seen, shape)
    if seen.corners_px is None:
        return np.zeros_like(mask)
    _, labels = cv2.connectedComponents((mask > 0).astype(np.uint8), connectivity=4)
    inside = np.zeros(mask.shape, dtype=np.uint8)
    cv2.fillConvexPoly(inside, np.rint(seen.corners_px).astype(np.int32), 1)
    sizes = np.bincount(np.asarray(labels)[inside > 0].ravel(), minlength=2)
    sizes[0] = 0
    chosen = int(np.argmax(sizes))
    return np.asarray((labels == chosen) & (chosen > 0), dtype=np.uint8)


def mask_iou(a: NDArray[np.uint8], b: NDArray[np.uint8]) -> float:
    """Shared pixels over all pixels of two masks of one size."""
    together = np.count_nonzero((a > 0) | (b > 0))
    return np.count_nonzero((a > 0) & (b > 0)) / together if together else 0.0


def width_px(corners: NDArray[np.float64]) -> float:
    """Of a box (4, 2) top left, top right, bottom right, bottom left."""
    top, bottom = corners[1] - corners[0], corners[2] - corners[3]
    return float(0.5 * (np.linalg.norm(top) + np.linalg.norm(bottom)))


def polygon_iou(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Of two convex quadrilaterals (4, 2)."""
    first, second = a.astype(np.float32), b.astype(np.float32)
    shared = float(cv2.intersectConvexConvex(first, second)[0])
    both = float(cv2.contourArea(first) + cv2.contourArea(second)) - shared
    return shared / both if both > 0.0 else 0.0


def _median(values: list[float]) -> float | None:
    return statistics.median(values) if values else None


def _share(flags: list[bool]) -> float | None:
    return sum(flags) / len(flags) if flags else None
