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
from naod.pose.explore import READINGS
from naod.pose.fit import LAST_ROW, Fit
from naod.pose.lens import lens_of
from naod.pose.objects import ObjectShape
from naod.pose.reading import Reading
from naod.pose.refine import (
    BLUR,
    PLACES_MAX,
    SPAN,
    TALLY,
    find_edges,
    find_readings,
    fit_edges,
)
from naod.pose.uncertainty import EdgeNoise, stated

SHARP_RISE_PX = 3.2
"""Width of a step without motion, as bilinear samples of shared chroma show it."""

BLURRED = 1.25
"""How much wider a step is before that is called motion."""

HALF = 0.5


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
        self.weights, self.trust = np.empty(n), np.empty(n)


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
    poses, count = np.empty((READINGS, 3, 4)), 1
    poses[0] = coarse.T_camera_object[:3]
    if coarse.other is not None:
        poses[1], count = coarse.other[:3], 2
    count = find_readings(yuyv, *what, poses, count, grain_px, lens, s.tally)
    if count == 0:
        return None
    n = find_edges(
        yuyv, *what, poses[0], lens, s.points, s.sigmas, s.looked, s.tally,
        s.residuals, s.jacobian, s.edges, s.weights, s.trust,
    )  # fmt: skip
    if n == 0:
        return None
    best, gap = _settle(what, poses, count, n, lens, s)
    figures_of_noise = noise.figures
    seen, support = _shares(
        s.residuals[:n],
        s.edges[:n],
        s.looked,
        noise.fits_px * max(1.0, s.tally[BLUR] / SHARP_RISE_PX),
    )
    blurred(figures_of_noise, s.tally[BLUR], s.tally[SPAN])
    total = stated(
        what[0], poses[best], s.residuals[:n], s.jacobian[:n], s.edges[:n], s.weights[:n],
        s.trust[:n], figures_of_noise,
    )  # fmt: skip
    fit = Fit(
        np.vstack([poses[best], LAST_ROW]), s.residuals[:n], s.jacobian[:n], s.edges[:n],
        s.weights[:n],
    )  # fmt: skip
    other = np.vstack([poses[1 - best], LAST_ROW]) if count > 1 else None
    reading = Reading(fit, s.points[:n], s.trust[:n], support)
    return Seen(reading, total, blur_of(float(s.tally[BLUR])), seen, other, gap)


def blur_of(rise_px: float) -> float:
    """Width of the motion that makes a step so wide; 0 where it is no wider than without."""
    if rise_px < BLURRED * SHARP_RISE_PX:
        return 0.0
    return math.sqrt(rise_px**2 - SHARP_RISE_PX**2)


def _settle(
    what: tuple[int, float, float],
    poses: NDArray[np.float64],
    count: int,
    n: int,
    lens: NDArray[np.float64],
    s: _Scratch,
) -> tuple[int, float]:
    """Which of the readings fits the edges best, which are then those of `s`; and the gap."""
    if count == 1:
        return 0, math.inf
    t = _Scratch()
    if not fit_edges(
        *what, poses[1], s.points[:n], s.sigmas[:n], lens,
        t.residuals[:n], t.jacobian[:n], t.edges[:n], t.weights[:n], t.trust[:n],
    ):  # fmt: skip
        return 0, math.inf
    gap = misfit_gap(s.residuals[:n], t.residuals[:n], s.trust[:n])
    if gap >= 0.0:
        return 0, gap
    s.residuals, s.jacobian, s.edges, s.weights = t.residuals, t.jacobian, t.edges, t.weights
    return 1, -gap


OUTLIER = 3.0
"""Standard deviations beyond which a residual says no more than that it does not fit."""

SIGMA_LEAST_PX = 0.05


@njit(cache=True, nogil=True)
def misfit_gap(
    first: NDArray[np.float64], second: NDArray[np.float64], trust: NDArray[np.float64]
) -> float:
    """By how much the second residuals (n,) are worse: squared deviations, cut at OUTLIER."""
    sigma = max(SIGMA_LEAST_PX, 1.4826 * min(np.median(np.abs(first)), np.median(np.abs(second))))
    total = 0.0
    for i in range(first.size):
        scale = math.sqrt(trust[i]) / sigma
        total -= min(abs(first[i]) * scale, OUTLIER) ** 2
        total += min(abs(second[i]) * scale, OUTLIER) ** 2
    return total


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


EDGE, PER_POINT = 2, 3
SHADED = 0.06
"""Share of a blur that is as wide as the object by which its edges may seem shifted."""

SMALL_PX = 15.0
"""Width of an object on which straight pieces and plateaus are twice as coarse a description."""


@njit(cache=True, nogil=True)
def blurred(noise: NDArray[np.float64], rise_px: float, span_px: float) -> None:
    """Figures of noise where steps are so wide, on an object so wide: more neighbours err together.

    An edge that mixes with the object's other side has no plateau to be half-way from.
    """
    wider, span_px = math.sqrt(max(1.0, rise_px / SHARP_RISE_PX)), max(span_px, 1.0)
    noise[PER_POINT] *= wider
    noise[EDGE] *= wider * (1.0 + SMALL_PX / span_px)
    if wider > BLURRED:
        noise[EDGE] += SHADED * rise_px * rise_px / span_px
