"""The object's edges in a picture and the poses that fit them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.geometry.camera import PinholeCamera
from naod.pose.coarse import CoarseFit
from naod.pose.contour import figures
from naod.pose.fit import LAST_ROW, Fit
from naod.pose.lens import lens_of
from naod.pose.noise import COMMON, EdgeNoise
from naod.pose.objects import ObjectShape
from naod.pose.reading import Reading
from naod.pose.refine import PLACES_MAX, find_edges
from naod.pose.rivals import RIVALS_MAX, add_rivals, settle
from naod.pose.tally import BLUR, RISE, RISE_ASIDE, SHARP_RISE_PX, TALLY, aliased, mixed_px
from naod.pose.uncertainty import stated
from naod.pose.wide import find_readings

BLURRED = 1.25
"""How much wider a step is before that is called motion."""

HALF = 0.5
SUPPORTED, DOUBTFUL = 0.88, 12.0
"""Where less of an outline has edges close to it, others may not be the object's either: sigma is
larger by so many times the lack."""


@dataclass(frozen=True, slots=True)
class Seen:
    """The reading that fits best, and the covariance of its pose.

    `other`: (4, 4) a second reading and `gap`: by how much worse it fits, in squared deviations.
    `blur_px`: as `ObjectPose` has it. `edges_seen`: (4,) whether half of each edge was found.
    """

    reading: Reading
    covariance: NDArray[np.float64]
    blur_px: float
    edges_seen: NDArray[np.bool_]
    other: NDArray[np.float64] | None = None
    gap: float = math.inf


class _Scratch:
    """What is measured at the places of one outline."""

    def __init__(self) -> None:
        n = PLACES_MAX
        self.points, self.sigmas = np.empty((n, 2)), np.empty(n)
        self.looked, self.tally = np.zeros(4, dtype=np.int64), np.zeros(TALLY)
        self.residuals, self.jacobian = np.empty(n), np.empty((n, 6))
        self.edges = np.empty(n, dtype=np.int64)
        self.groups = np.empty(n, dtype=np.int64)
        self.weights, self.trust = np.empty(n), np.empty(n)
        self.spreads, self.offsets = np.zeros(4), np.zeros(4)


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
    s, lens, what = _Scratch(), lens_of(camera), figures(shape)
    poses, count = np.empty((RIVALS_MAX, 3, 4)), 1
    poses[0] = coarse.T_camera_object[:3]
    if coarse.other is not None:
        poses[1], count = coarse.other[:3], 2
    count = find_readings(yuyv, *what, poses, count, grain_px, lens, s.tally)
    if count == 0:
        return None
    n = find_edges(
        yuyv, *what, poses[0], lens, noise.figures, s.points, s.sigmas, s.groups, s.looked,
        s.tally, s.residuals, s.jacobian, s.edges, s.weights, s.trust, s.spreads, s.offsets,
    )  # fmt: skip
    if n == 0:
        return None
    count = add_rivals(*what, poses, count)
    gap = settle(
        *what, poses, count, s.points[:n], s.sigmas[:n], s.groups[:n], lens, s.spreads,
        s.residuals[:n], s.jacobian[:n], s.edges[:n], s.weights[:n], s.trust[:n], s.offsets,
    )  # fmt: skip
    return _told(what[0], poses, gap, n, s, noise)


def _told(
    kind: int,
    poses: NDArray[np.float64],
    gap: float,
    n: int,
    s: _Scratch,
    noise: EdgeNoise,
) -> Seen:
    """What n edge points say of the first of the poses, the second being `gap` behind."""
    fits_px = noise.fits_px * max(1.0, s.tally[BLUR] / SHARP_RISE_PX)
    seen, support = _shares(s.residuals[:n], s.edges[:n], s.looked, fits_px)
    sharpest = mixed_px(min(s.tally[RISE], s.tally[RISE_ASIDE]), SHARP_RISE_PX)
    figures_of_noise = noise.figures
    figures_of_noise[COMMON] *= aliased(sharpest)
    total = stated(
        kind, poses[0], s.residuals[:n], s.jacobian[:n], s.groups[:n], s.weights[:n],
        s.trust[:n], s.spreads, s.offsets, figures_of_noise,
    )  # fmt: skip
    fit = Fit(
        np.vstack([poses[0], LAST_ROW]), s.residuals[:n], s.jacobian[:n], s.edges[:n],
        s.weights[:n], s.groups[:n], s.spreads, s.offsets,
    )  # fmt: skip
    total *= (1.0 + DOUBTFUL * max(SUPPORTED - support, 0.0)) ** 2
    other = np.vstack([poses[1], LAST_ROW]) if math.isfinite(gap) else None
    reading = Reading(fit, s.points[:n], s.trust[:n], support)
    return Seen(reading, total, blur_of(float(s.tally[BLUR])), seen, other, gap)


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
) -> tuple[NDArray[np.bool_], float]:
    """Which edges were found for half of what the picture could show; share of all found."""
    near, seen, total = np.zeros(4, dtype=np.int64), np.zeros(4, dtype=np.bool_), 0
    for i in range(residuals.size):
        if abs(residuals[i]) < fits_px:
            near[edges[i]] += 1
    for k in range(4):
        seen[k] = near[k] > 0 and near[k] >= HALF * looked[k]
        total += near[k]
    return seen, total / max(looked.sum(), 1)
