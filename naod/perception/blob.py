"""The object among the regions of a mask, and its oriented box (Algorithm 1: G, H, J, K)."""

from __future__ import annotations

import cv2
import msgspec
import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.box import Box, Found, breaks_of_labels, measure_box
from naod.perception.components import components
from naod.perception.runs import AREA, BOTTOM, LEFT, RIGHT, SUM_X, SUM_Y, TOP
from naod.perception.segmenter import Segmentation

PIXELS_MIN = 12
"""Reduced pixels below which a region is no object."""

_SIDES = ("left", "right", "top", "bottom")
_CLIPPED = tuple(
    tuple(side for bit, side in enumerate(_SIDES) if cut >> bit & 1) for cut in range(16)
)


class Blob(msgspec.Struct, frozen=True, eq=False):
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
    A segmenter has looked for it already, with its own `pixels_min`.
    """
    sight = segmentation.sight
    if sight is not None and sight.pixels_min == pixels_min:
        if sight.pixels == 0:
            return None
        return _blob(sight.found, sight.points, sight.cut, sight.pixels, segmentation.scale)
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
    corners, centre, boundary, cut, pixels = _drawn(
        labels, np.ascontiguousarray(table), wanted, float(grain_px)
    )
    return _blob(Found(corners, centre, boundary), len(boundary), cut, pixels, grain_px)


def _blob(found: Found, points: int, cut: int, pixels: int, grain_px: float) -> Blob:
    area_px = pixels * grain_px**2
    boundary = found.boundary[:points]
    return Blob(found.centre, area_px, found.corners, boundary, grain_px, _CLIPPED[cut])


@njit(cache=True, nogil=True)
def _together(
    table: NDArray[np.int64], wanted: NDArray[np.bool_], extent: NDArray[np.int64]
) -> None:
    """One line of a table of regions for several of them."""
    extent[:] = 0
    extent[LEFT] = extent[TOP] = np.iinfo(np.int64).max
    for k in range(table.shape[0]):
        if wanted[k + 1]:
            for column in (AREA, SUM_X, SUM_Y):
                extent[column] += table[k, column]
            for column in (LEFT, TOP):
                extent[column] = min(extent[column], table[k, column])
            for column in (RIGHT, BOTTOM):
                extent[column] = max(extent[column], table[k, column])


@njit(cache=True, nogil=True)
def _drawn(
    labels: NDArray[np.int32],
    table: NDArray[np.int64],
    wanted: NDArray[np.bool_],
    grain_px: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], int, int]:
    """Corners, centre and boundary px, the sides cut, and pixels of regions as one."""
    height, width = labels.shape
    extent = np.empty(table.shape[1], dtype=np.int64)
    _together(table, wanted, extent)
    rows, columns = extent[BOTTOM] - extent[TOP] + 1, extent[RIGHT] - extent[LEFT] + 1
    box = Box(
        np.empty((4, 2)),
        np.empty(2),
        np.empty((2 * (rows + 1) * (columns + 1), 2)),
        np.empty(rows * (columns + 1) + 1, dtype=np.int32),
        np.empty(height + 3, dtype=np.int32),
        np.empty((2 * height + 1, 2), dtype=np.int32),
        np.empty((4 * height + 4, 2), dtype=np.int32),
    )
    breaks_of_labels(labels, wanted, extent, box)
    points, cut = measure_box(box, extent, height, width, grain_px)
    return box.corners, box.centre, box.boundary[:points].copy(), cut, extent[AREA]


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
