"""A pose at a glance: from a blob's outline alone, in a fraction of a millisecond."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.geometry.camera import PinholeCamera
from naod.geometry.transforms import closed
from naod.perception.blob import Blob
from naod.pose.around import lonely_share, places_around, visible_area
from naod.pose.contour import CYLINDER, VERTICES, figures, seen_outline
from naod.pose.convex import convex_points
from naod.pose.explore import POINTS, READINGS, explore, residuals_of
from naod.pose.guesses import (
    GUESSES_MAX,
    cut_rectangle_guesses,
    cylinder_guesses,
    rectangle_guesses,
)
from naod.pose.lens import HEIGHT, WIDTH, focal, from_pixels, lens_of
from naod.pose.objects import ObjectShape
from naod.pose.prior import Prior
from naod.pose.quadrilateral import quadrilateral

POINTS_MIN = 12
MOST = 4000
"""More points than any outline has come from noise, and only take time."""

PLACES = 48
"""Around the outline, where it is asked whether the blob ends there."""

FITS_GRAINS = 0.75
"""A point of a blob further than this from the outline belongs to something else."""

EXPLAINS_GRAINS2, EXPLAINS_SUPPORT = 0.25, 0.85
"""What a prior has to come to for nothing else to be tried."""

CUT_SLACK_PX = 2.0


@dataclass(frozen=True, slots=True)
class CoarseFit:
    """What a blob's outline says of the object.

    `T_camera_object`: (4, 4). `misfit_grains2`: mean squared distance of the blob's outline from
    the object's, in squares of `Blob.grain_px`, each cut at 4 grains. `support`: share of the
    object's outline, as far as the picture shows it, where the blob ends too. `area_px`: pixels of
    the picture the object would cover. `gaps`: share of the outline where the blob does not end.
    `other`: the second reading of a tilt, if there is one.
    """

    T_camera_object: NDArray[np.float64]
    misfit_grains2: float
    support: float
    area_px: float
    gaps: float = 0.0
    other: NDArray[np.float64] | None = None


def coarse_fit(
    blob: Blob, shape: ObjectShape, camera: PinholeCamera, near: Prior | None = None
) -> CoarseFit | None:
    """The pose that explains a blob's outline best; None where nothing does.

    near: where the object is expected; tried first, and alone where it explains the outline. It is
    a fit to pixels of a mask: good for choosing between blobs and for knowing where to look.
    """
    poses, found = np.empty((READINGS, 3, 4)), np.empty(FOUND)
    hint = _NOWHERE if near is None else np.ascontiguousarray(near.T_camera_object[:3])
    box = np.ascontiguousarray(blob.corners_px, dtype=np.float64)
    count = _fit(
        *figures(shape), _boundary(blob), box, blob.grain_px, _sides(blob.clipped), lens_of(camera),
        hint, near is not None, poses, found,
    )  # fmt: skip
    if count == 0:
        return None
    other = closed(poses[1]) if count > 1 else None
    cost, support, area, gaps = found.tolist()
    return CoarseFit(closed(poses[0]), cost, support, area, gaps, other)


def outline_points(blob: Blob, most: int = POINTS) -> NDArray[np.float64]:
    """Points (n, 2) px of a blob's boundary, about so many, where it is convex.

    The shapes looked for are convex; dents and holes are not theirs.
    """
    return np.asarray(_outline(_boundary(blob), blob.grain_px, most))


def _boundary(blob: Blob) -> NDArray[np.float64]:
    return np.ascontiguousarray(blob.boundary_px, dtype=np.float64)


@njit(cache=True, nogil=True)
def _outline(boundary: NDArray[np.float64], grain_px: float, most: int) -> NDArray[np.float64]:
    if boundary.shape[0] < POINTS_MIN:
        return boundary
    every = max(1, boundary.shape[0] // (2 * most))
    return convex_points(boundary, every, 1.5 * grain_px, most)


COST, SUPPORT, AREA, GAPS = range(4)
FOUND = 4
_SIDES = ("left", "top", "right", "bottom")
_NOWHERE: NDArray[np.float64] = np.zeros((3, 4))


@lru_cache(maxsize=16)
def _sides(clipped: tuple[str, ...]) -> NDArray[np.bool_]:
    return np.array([side in clipped for side in _SIDES])


@njit(cache=True, nogil=True)
def _cut(
    corners: NDArray[np.float64],
    grain: float,
    sides: NDArray[np.bool_],
    lens: NDArray[np.float64],
    cut: NDArray[np.bool_],
) -> None:
    """Which edges of a box (4, 2) px are the picture's border: top, right, bottom, left."""
    slack = 2.0 * grain + CUT_SLACK_PX
    for k in range(4):
        after = (k + 1) % 4
        x = 0.5 * (corners[k, 0] + corners[after, 0])
        y = 0.5 * (corners[k, 1] + corners[after, 1])
        cut[k] = (
            (sides[0] and x < slack)
            or (sides[1] and y < slack)
            or (sides[2] and x > lens[WIDTH] - 1.0 - slack)
            or (sides[3] and y > lens[HEIGHT] - 1.0 - slack)
        )


@njit(cache=True, nogil=True)
def _guess(
    kind: int,
    half_width: float,
    half_height: float,
    boundary: NDArray[np.float64],
    box: NDArray[np.float64],
    grain: float,
    sides: NDArray[np.bool_],
    lens: NDArray[np.float64],
    guesses: NDArray[np.float64],
) -> int:
    corners, four, cut = np.empty((4, 2)), np.empty((4, 2)), np.zeros(4, dtype=np.bool_)
    seen = np.empty((4, 2))
    from_pixels(lens, box, corners)
    _cut(box, grain, sides, lens, cut)
    if kind == CYLINDER:
        return cylinder_guesses(half_width, half_height, corners, cut, guesses)
    count = 0
    # corners are single points: all of the boundary is asked for them
    if not sides.any() and quadrilateral(boundary, box, seen):
        from_pixels(lens, seen, four)
        count = rectangle_guesses(half_width, half_height, four, guesses)
    if count == 0:
        count = cut_rectangle_guesses(half_width, half_height, corners, cut, guesses)
    return count


@njit(cache=True, nogil=True)
def _judge(
    kind: int,
    half_width: float,
    half_height: float,
    T: NDArray[np.float64],
    boundary: NDArray[np.float64],
    points: NDArray[np.float64],
    grain_px: float,
    lens: NDArray[np.float64],
    found: NDArray[np.float64],
) -> None:
    """Cost, support and area of a pose into `found`."""
    image, names = np.empty((VERTICES, 3)), np.empty(VERTICES, dtype=np.int64)
    places, normals = np.empty((PLACES, 2)), np.empty((PLACES, 2))
    edges = np.empty(PLACES, dtype=np.int64)
    pieces = seen_outline(kind, half_width, half_height, T, image, names)
    count = places_around(image, names, pieces, lens, PLACES, 1.0, places, normals, edges)
    residuals = residuals_of(kind, half_width, half_height, T, points)
    grain, near, total = grain_px / focal(lens), 0, 0.0
    for k in range(residuals.size):
        gap = min(abs(residuals[k]) / grain, 4.0)
        near += gap < FITS_GRAINS
        total += gap * gap
    gaps = lonely_share(places, count, boundary, lens, grain_px)
    found[GAPS] = gaps
    found[COST] = total / residuals.size
    found[SUPPORT] = near / residuals.size * (1.0 - gaps)
    found[AREA] = visible_area(image, pieces, lens)


@njit(cache=True, nogil=True)
def _fit(
    kind: int,
    half_width: float,
    half_height: float,
    boundary: NDArray[np.float64],
    box: NDArray[np.float64],
    grain_px: float,
    sides: NDArray[np.bool_],
    lens: NDArray[np.float64],
    hint: NDArray[np.float64],
    hinted: bool,
    poses: NDArray[np.float64],
    found: NDArray[np.float64],
) -> int:
    """Readings of a blob's boundary, the best first; returns how many."""
    points_px = _outline(boundary, grain_px, POINTS)
    if points_px.shape[0] < POINTS_MIN:
        return 0
    if boundary.shape[0] >= 2 * MOST:
        boundary = boundary[:: boundary.shape[0] // MOST].copy()
    grain, points = grain_px / focal(lens), np.empty(points_px.shape)
    guesses = np.empty((GUESSES_MAX, 3, 4))
    from_pixels(lens, points_px, points)
    count = 0
    if hinted:
        guesses[0] = hint
        count = explore(kind, half_width, half_height, points, guesses, 1, grain, poses)
    for attempt in range(2):
        if count > 0:
            _judge(kind, half_width, half_height, poses[0], boundary, points, grain_px, lens, found)
        explained = found[COST] < EXPLAINS_GRAINS2 and found[SUPPORT] > EXPLAINS_SUPPORT
        if attempt == 1 or (count > 0 and explained):
            break
        start = 1 if hinted else 0
        start += _guess(
            kind, half_width, half_height, boundary, box, grain_px, sides, lens, guesses[start:]
        )
        count = explore(kind, half_width, half_height, points, guesses, start, grain, poses)
    return count
