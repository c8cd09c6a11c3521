"""The object's edges in a picture and the poses that fit them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.geometry.camera import PinholeCamera
from naod.geometry.transforms import closed
from naod.pose.coarse import CoarseFit
from naod.pose.contour import VERTICES, figures, pixels_of, take_corners
from naod.pose.fit import Fit
from naod.pose.lens import focal, lens_of
from naod.pose.noise import COMMON, FLOOR, SCATTER, UNSTEADY, EdgeNoise
from naod.pose.objects import ObjectShape
from naod.pose.reading import Reading
from naod.pose.refine import PLACES_MAX, find_edges
from naod.pose.rivals import RIVALS_MAX, add_rivals, settle
from naod.pose.shared import point_sigma
from naod.pose.tally import BLUR, RISE, RISE_ASIDE, SHARP_RISE_PX, TALLY, aliased, mixed_px
from naod.pose.uncertainty import add_turn, stated
from naod.pose.wide import find_readings

BLURRED = 1.25
"""How much wider a step is before that is called motion."""

MOVING_PX = 3.0
"""A camera that is seen to move so far during an exposure may do so unevenly."""

SCATTER_PER_PX, SCATTER_MOST = 0.08, 2.0
"""How much more points scatter per px of a step's width, and what is the most that it counts for.
Before photographs sigma grows with the square of it."""

HALF = 0.5
SUPPORTED, DOUBTFUL = 0.88, 12.0
"""Where less of an outline has edges close to it, others may not be the object's either: sigma is
larger by so many times the lack."""


_Measured = tuple[
    NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.int64],
    NDArray[np.float64], NDArray[np.int64], NDArray[np.float64], NDArray[np.float64],
    NDArray[np.float64],
]  # fmt: skip


@dataclass(frozen=True, slots=True)
class Seen:
    """The reading that fits best, the covariance of its pose and where its corners are.

    `other`: (4, 4) a second reading and `gap`: by how much worse it fits, in squared deviations.
    `blur_px`: as `ObjectPose` has it. `edges_seen`: (4,) whether half of each edge was found.
    """

    reading: Reading
    covariance: NDArray[np.float64]
    corners_px: NDArray[np.float64]
    blur_px: float
    edges_seen: NDArray[np.bool_]
    other: NDArray[np.float64] | None = None
    gap: float = math.inf


def see(
    yuyv: NDArray[np.uint8],
    coarse: CoarseFit,
    grain_px: float,
    shape: ObjectShape,
    camera: PinholeCamera,
    noise: EdgeNoise,
) -> Seen | None:
    """The edges near a coarse fit and what they say; None where too few are seen.

    grain_px: resolution of what the coarse fit was made to.
    """
    poses, count = np.empty((RIVALS_MAX, 3, 4)), 1
    poses[0] = coarse.T_camera_object[:3]
    if coarse.other is not None:
        poses[1], count = coarse.other[:3], 2
    gap, support, rise_px, seen, total, corners, measured = _see(
        yuyv, *figures(shape), poses, count, grain_px, lens_of(camera), noise.figures,
        noise.fits_px,
    )  # fmt: skip
    points, residuals, jacobian, edges, weights, groups, trust, spreads, offsets = measured
    if not len(points):
        return None
    T = closed(poses[0])
    fit = Fit(T, residuals, jacobian, edges, weights, groups, spreads, offsets)
    other = closed(poses[1]) if math.isfinite(gap) else None
    reading = Reading(fit, points, trust, support)
    return Seen(reading, total, corners, blur_of(rise_px), seen, other, gap)


def blur_of(rise_px: float) -> float:
    """Width of the motion that makes a step so wide; 0 where it is no wider than without."""
    if rise_px < BLURRED * SHARP_RISE_PX:
        return 0.0
    return math.sqrt(rise_px**2 - SHARP_RISE_PX**2)


@njit(cache=True, nogil=True)
def _shares(
    residuals: NDArray[np.float64],
    edges: NDArray[np.int64],
    looked: NDArray[np.int64],
    fits_px: float,
    seen: NDArray[np.bool_],
) -> float:
    """Fill which edges (4,) were found for half of what the picture could show; share of all."""
    near, total = np.zeros(4, dtype=np.int64), 0
    for i in range(residuals.size):
        if abs(residuals[i]) < fits_px:
            near[edges[i]] += 1
    for k in range(4):
        seen[k] = near[k] > 0 and near[k] >= HALF * looked[k]
        total += near[k]
    return float(total / max(looked.sum(), 1))


@njit(cache=True, nogil=True)
def _see(
    yuyv: NDArray[np.uint8],
    kind: int,
    half_width: float,
    half_height: float,
    poses: NDArray[np.float64],
    count: int,
    grain_px: float,
    lens: NDArray[np.float64],
    noise: NDArray[np.float64],
    fits_px: float,
) -> tuple[
    float, float, float, NDArray[np.bool_], NDArray[np.float64], NDArray[np.float64], _Measured
]:
    """Moves poses (RIVALS_MAX, 3, 4), `count` of them given, to what the edges say, best first.

    Returns by how much worse the second fits, infinite if there is none; what is found of the
    outline; the width of its blurred steps; whether half of each edge is; the best one's
    covariance and corners (4, 2) px; and n points, residuals, Jacobian, edges, weights, groups,
    trust, spreads and offsets as `Fit` and `Reading` have them, none where too few are seen.
    """
    most, gap, support, n = PLACES_MAX, np.inf, 0.0, 0
    points, sigmas, groups = np.empty((most, 2)), np.empty(most), np.empty(most, dtype=np.int64)
    residuals, jacobian, edges = np.empty(most), np.empty((most, 6)), np.empty(most, dtype=np.int64)
    weights, trust, spreads, offsets = np.empty(most), np.empty(most), np.zeros(4), np.zeros(4)
    looked, tally = np.zeros(4, dtype=np.int64), np.zeros(TALLY)
    total, seen = np.empty((6, 6)), np.zeros(4, dtype=np.bool_)
    pixels, corners = np.empty((VERTICES, 2)), np.empty((4, 2))
    rivals = find_readings(yuyv, kind, half_width, half_height, poses, count, grain_px, lens, tally)
    if rivals > 0:
        n = find_edges(
            yuyv, kind, half_width, half_height, poses[0], lens, noise, points, sigmas, groups,
            looked, tally, residuals, jacobian, edges, weights, trust, spreads, offsets,
        )  # fmt: skip
    measured = (
        points[:n], residuals[:n], jacobian[:n], edges[:n], weights[:n], groups[:n], trust[:n],
        spreads, offsets,
    )  # fmt: skip
    if n > 0:
        rivals = add_rivals(kind, half_width, half_height, poses, rivals)
        gap = settle(
            kind, half_width, half_height, poses, rivals, points[:n], sigmas[:n], groups[:n], lens,
            spreads, residuals[:n], jacobian[:n], edges[:n], weights[:n], trust[:n], offsets,
        )  # fmt: skip
        near = fits_px * max(1.0, tally[BLUR] / SHARP_RISE_PX)
        support = _shares(residuals[:n], edges[:n], looked, near, seen)
        total[:] = _told(kind, poses[0], tally, measured, noise)
        add_turn(poses[0, :, 3], _unsteady(tally, noise) / focal(lens), total)
        pixels_of(kind, half_width, half_height, poses[0], lens, pixels)
        take_corners(kind, pixels, corners)
        total *= (1.0 + DOUBTFUL * max(SUPPORTED - support, 0.0)) ** 2
        total *= _cluttered(tally, measured, noise) ** 2
    return gap, support, tally[BLUR], seen, total, corners, measured


@njit(cache=True, nogil=True)
def _unsteady(tally: NDArray[np.float64], noise: NDArray[np.float64]) -> float:
    """How far the picture as a whole may be from the middle of its exposure, px."""
    moved = math.hypot(
        mixed_px(tally[RISE], SHARP_RISE_PX), mixed_px(tally[RISE_ASIDE], SHARP_RISE_PX)
    )
    return noise[UNSTEADY] * min(moved / MOVING_PX, 1.0) ** 2


@njit(cache=True, nogil=True)
def _cluttered(
    tally: NDArray[np.float64], measured: _Measured, noise: NDArray[np.float64]
) -> float:
    """How much larger sigma is where edge points scatter more than motion explains."""
    _, residuals, _, _, weights, groups, trust, _, offsets = measured
    sigma = point_sigma(residuals, weights, trust, groups, offsets, noise[FLOOR])
    usual = noise[SCATTER] * math.hypot(1.0, SCATTER_PER_PX * max(tally[RISE], tally[RISE_ASIDE]))
    return min(max(sigma / usual, 1.0), SCATTER_MOST) ** 2


@njit(cache=True, nogil=True)
def _told(
    kind: int,
    T: NDArray[np.float64],
    tally: NDArray[np.float64],
    measured: _Measured,
    noise: NDArray[np.float64],
) -> NDArray[np.float64]:
    """(6, 6) of the pose (3, 4) that edges give; the more blurred they are, the less aliased."""
    _, residuals, jacobian, _, weights, groups, trust, spreads, offsets = measured
    own = noise.copy()
    own[COMMON] *= aliased(mixed_px(min(tally[RISE], tally[RISE_ASIDE]), SHARP_RISE_PX))
    return stated(kind, T, residuals, jacobian, groups, weights, trust, spreads, offsets, own)
