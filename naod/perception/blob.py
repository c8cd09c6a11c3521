"""The object among the regions of a mask, and its oriented box (Algorithm 1: G, H, J, K)."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.components import (
    AREA,
    BOTTOM,
    LEFT,
    RIGHT,
    SUM_X,
    SUM_Y,
    TOP,
    boundary,
    components,
)
from naod.perception.segmenter import Segmentation

PIXELS_MIN = 12
"""Reduced pixels below which a region is no object."""


@dataclass(frozen=True, slots=True)
class Blob:
    """A region of a mask, in pixels of the full picture (centres at whole numbers).

    `centre_px`: (2,) centroid. `area_px`: full pixels. `corners_px`: (4, 2) oriented box G, H, J,
    K: top left, top right, bottom right, bottom left. `boundary_px`: (n, 2) points where it ends
    inside the picture. `grain_px`: side of a mask pixel, the resolution of all this. `clipped`:
    sides of the picture that cut it, of "left", "right", "top", "bottom".
    """

    centre_px: NDArray[np.float64]
    area_px: float
    corners_px: NDArray[np.float64]
    boundary_px: NDArray[np.float64]
    grain_px: float
    clipped: tuple[str, ...]


def find_blob(segmentation: Segmentation, pixels_min: int = PIXELS_MIN) -> Blob | None:
    """The region of touching pixels that has most of the object's colour.

    None if none has `pixels_min`. Without the segmentation's differences it is the largest one.
    """
    labels, table = components(segmentation.mask)
    if not len(table) or table[:, AREA].max() < pixels_min:
        return None
    weights = table[:, AREA].astype(np.float64)
    if segmentation.differences is not None and len(table) > 1:
        weights = evidence(labels, segmentation.differences, len(table))
        weights[table[:, AREA] < pixels_min] = -1.0
    wanted = np.zeros(len(table) + 1, dtype=np.bool_)
    wanted[1 + int(np.argmax(weights))] = True
    return blob_of(labels, table, wanted, segmentation.scale)


@njit(cache=True, nogil=True)
def evidence(
    labels: NDArray[np.int32], differences: NDArray[np.int32], count: int
) -> NDArray[np.float64]:
    """(count,) float64: steps by which the pixels of each region are likelier object.

    A pixel that is likelier background counts nothing: the field closed a hole there.
    """
    sums = np.zeros(count, dtype=np.float64)
    for i in range(labels.shape[0]):
        for j in range(labels.shape[1]):
            label = labels[i, j]
            if label > 0 and differences[i, j] < 0:
                sums[label - 1] -= differences[i, j]
    return sums


def blob_of_mask(mask: NDArray[np.uint8], pixels_min: int = PIXELS_MIN) -> Blob | None:
    """All of a mask (H, W) that somebody else made, non-zero = object; None if next to nothing.

    Regions below a twentieth of the largest one are taken for stray pixels.
    """
    labels, table = components(mask)
    if not len(table) or table[:, AREA].max() < pixels_min:
        return None
    wanted = np.zeros(len(table) + 1, dtype=np.bool_)
    wanted[1:] = table[:, AREA] * 20 >= table[:, AREA].max()
    return blob_of(labels, table, wanted, 1.0)


def blob_of(
    labels: NDArray[np.int32],
    table: NDArray[np.int64],
    wanted: NDArray[np.bool_],
    grain_px: float,
) -> Blob:
    """The regions with `wanted[label]` as one object; `labels` and `table` as `components` gives.

    `grain_px`: full pixels per pixel of `labels`.
    """
    rows = table[wanted[1:]]
    area = rows[:, AREA].sum()
    centre = rows[:, [SUM_X, SUM_Y]].sum(axis=0) / area
    points = boundary(labels, wanted)
    return Blob(
        centre_px=_full(centre, grain_px),
        area_px=float(area) * grain_px**2,
        corners_px=_full(_box(points, rows, labels.shape), grain_px),
        boundary_px=_full(points, grain_px),
        grain_px=grain_px,
        clipped=_clipped(rows, labels.shape),
    )


UP = np.array([0.0, -1.0])
"""Towards the top of a picture."""


def oriented_box(points: NDArray[np.float64], up: NDArray[np.float64] = UP) -> NDArray[np.float64]:
    """(4, 2) corners G, H, J, K of the smallest rectangle around points (n, 2)."""
    box = cv2.boxPoints(cv2.minAreaRect(points.astype(np.float32)))
    return ordered_corners(np.asarray(box, dtype=np.float64), up)


def ordered_corners(
    corners: NDArray[np.float64], up: NDArray[np.float64] = UP
) -> NDArray[np.float64]:
    """Four corners (4, 2) as top left, top right, bottom right, bottom left, as seen.

    The upper edge is the one whose middle lies furthest along `up` from the centre.
    """
    offset = corners - corners.mean(axis=0)
    around = corners[np.argsort(np.arctan2(offset[:, 1], offset[:, 0]))]
    middles = (around + np.roll(around, -1, axis=0)) / 2.0
    return np.roll(around, -int(np.argmax(middles @ up)), axis=0)


def _full(points: NDArray[np.float64], grain_px: float) -> NDArray[np.float64]:
    """Mask pixels to full pixels: a mask pixel's centre is that of the block it stands for."""
    return (points + 0.5) * grain_px - 0.5


def _box(
    points: NDArray[np.float64], rows: NDArray[np.int64], shape: tuple[int, ...]
) -> NDArray[np.float64]:
    """Oriented box of the region in mask pixels, its cut sides included."""
    left, right = rows[:, LEFT].min() - 0.5, rows[:, RIGHT].max() + 0.5
    top, bottom = rows[:, TOP].min() - 0.5, rows[:, BOTTOM].max() + 0.5
    if len(points) < 3 or len(_clipped(rows, shape)) == 4:
        return np.array([[left, top], [right, top], [right, bottom], [left, bottom]])
    return oriented_box(points)


def _clipped(rows: NDArray[np.int64], shape: tuple[int, ...]) -> tuple[str, ...]:
    height, width = shape
    cut = {
        "left": rows[:, LEFT].min() == 0,
        "right": rows[:, RIGHT].max() == width - 1,
        "top": rows[:, TOP].min() == 0,
        "bottom": rows[:, BOTTOM].max() == height - 1,
    }
    return tuple(side for side, is_cut in cut.items() if is_cut)
