"""Where an edge lies, to a fraction of a pixel, at full resolution, along given normals.

Along each normal the colour goes from one plateau to another. The profile is projected on the
direction that separates the two best, the changes of brightness that shading makes inside counted
as noise; where it is that of half the light of either lies the edge, roughly. `placing` then puts
it exactly.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.geometry.linear import solve_symmetric
from naod.perception.encoding import mixture_scores
from naod.perception.placing import PAIRS_MAX, SHARES, place_edge

STEP_PX = 0.5
SAMPLES_MAX = 129
NOISE_LEVELS = 3.0
"""Standard deviation of one channel of one pixel, 8-bit levels."""

SHADING = 0.15
"""Relative standard deviation of brightness over a plateau inside."""

GATHERED2 = 0.9
"""Variance that shared chroma and bilinear samples add to a profile along a row, px squared."""

OFFSET, SIGMA, WIDTH, WITHIN = range(4)

SLOPE_MIN = 0.02
SLOPE_EXACT = 0.1
"""Where light mixes over more pixels than this says, their number is too large to matter."""

CONTRAST_MIN = 3.0
"""Separation of the plateaus, in standard deviations, below which there is no edge to see."""


@dataclass(frozen=True, slots=True)
class Edges:
    """Edges along n normals.

    `offset_px` (n,) from the given place, positive outwards; `sigma_px` (n,) by noise and slope;
    `width_px` (n,) over which the step rises, were it as steep all the way;
    `within` (n,) whether the picture reaches so far; `seen` (n,) whether there is an edge.
    """

    offset_px: NDArray[np.float64]
    sigma_px: NDArray[np.float64]
    width_px: NDArray[np.float64]
    within: NDArray[np.bool_]
    seen: NDArray[np.bool_]


@njit(cache=True, nogil=True)
def _colour_at(
    yuyv: NDArray[np.uint8], x: float, y: float, colours: NDArray[np.float64], k: int
) -> None:
    """Bilinear Y, U, V at a place into row k; the pairs' chroma lies between their pixels."""
    height, width = yuyv.shape[0], yuyv.shape[1]
    y, x = min(max(y, 0.0), height - 1.0), min(max(x, 0.0), width - 1.0)
    i, j = min(int(y), max(height - 2, 0)), min(int(x), max(width - 2, 0))
    below, beside = min(i + 1, height - 1), min(j + 1, width - 1)
    a, b = y - i, x - j
    upper = (1.0 - b) * yuyv[i, j, 0] + b * yuyv[i, beside, 0]
    lower = (1.0 - b) * yuyv[below, j, 0] + b * yuyv[below, beside, 0]
    colours[k, 0] = (1.0 - a) * upper + a * lower
    pair = min(max(0.5 * (x - 0.5), 0.0), width // 2 - 1.0)
    j = min(int(pair), max(width // 2 - 2, 0))
    b, j, beside = pair - j, 2 * j, 2 * min(j + 1, width // 2 - 1)
    for c in range(2):
        upper = (1.0 - b) * yuyv[i, j + c, 1] + b * yuyv[i, beside + c, 1]
        lower = (1.0 - b) * yuyv[below, j + c, 1] + b * yuyv[below, beside + c, 1]
        colours[k, 1 + c] = (1.0 - a) * upper + a * lower


@njit(cache=True, nogil=True)
def _profile(
    yuyv: NDArray[np.uint8],
    place: NDArray[np.float64],
    normal: NDArray[np.float64],
    reach: float,
    step: float,
    depth: float,
    colours: NDArray[np.float64],
) -> int:
    """Colours from `reach` inside to `reach` outside; no deeper inside than `depth`."""
    count = 2 * int(reach / step) + 1
    for k in range(count):
        s = max((k - count // 2) * step, -depth)
        _colour_at(yuyv, place[0] + s * normal[0], place[1] + s * normal[1], colours, k)
    return count


@njit(cache=True, nogil=True)
def _plateau(
    colours: NDArray[np.float64],
    first: int,
    last: int,
    mean: NDArray[np.float64],
    scatter: NDArray[np.float64],
) -> None:
    """Mean of rows first to last - 1, and half their covariance added to `scatter`."""
    n = last - first
    for c in range(3):
        mean[c] = 0.0
        for k in range(first, last):
            mean[c] += colours[k, c] / n
    for k in range(first, last):
        for c in range(3):
            for d in range(3):
                scatter[c, d] += 0.5 * (colours[k, c] - mean[c]) * (colours[k, d] - mean[d]) / n


@njit(cache=True, nogil=True)
def _separation(
    colours: NDArray[np.float64],
    count: int,
    inner: NDArray[np.float64],
    outer: NDArray[np.float64],
    direction: NDArray[np.float64],
) -> float:
    """Plateaus of a profile, the direction that tells them apart, and the contrast along it.

    `direction` is scaled so that it takes the inner plateau to the outer one in a step of 1.
    """
    scatter, gap = np.zeros((3, 3)), np.empty(3)
    quarter = max(count // 4, 1)
    _plateau(colours, 0, quarter, inner, scatter)
    _plateau(colours, count - quarter, count, outer, scatter)
    for c in range(3):
        gap[c] = outer[c] - inner[c]
        scatter[c, c] += NOISE_LEVELS**2
        for d in range(3):
            shade_c = inner[c] - (128.0 if c else 0.0)
            scatter[c, d] += SHADING**2 * shade_c * (inner[d] - (128.0 if d else 0.0))
    solve_symmetric(scatter, gap, direction)
    contrast2 = direction[0] * gap[0] + direction[1] * gap[1] + direction[2] * gap[2]
    if contrast2 < 1e-6:
        return 0.0
    direction /= contrast2
    return math.sqrt(contrast2)


@njit(cache=True, nogil=True)
def _split(scores: NDArray[np.float64], count: int, level: float) -> int:
    """Last sample inside, for the step that fits the whole profile best; -1 if there is none."""
    total, best, at = 0.0, 0.0, -1
    for k in range(count - 1):
        total += level - min(max(scores[k], -0.2), 1.2)
        if total > best:
            best, at = total, k
    return at


@njit(cache=True, nogil=True)
def _slope(scores: NDArray[np.float64], count: int, k: int, step: float) -> float:
    """Rise per pixel about the step after sample k; 0 where the profile ends too soon."""
    if k < 2 or k > count - 4:
        return 0.0
    return (scores[k + 3] - scores[k - 2]) / (5.0 * step)


@njit(cache=True, nogil=True)
def _crossing(
    colours: NDArray[np.float64],
    count: int,
    inner: NDArray[np.float64],
    direction: NDArray[np.float64],
    level: float,
    step: float,
    scores: NDArray[np.float64],
) -> tuple[float, float]:
    """Where a profile is at a level, px from its middle, and its slope; slope 0 if nowhere."""
    for k in range(count):
        scores[k] = 0.0
        for c in range(3):
            scores[k] += direction[c] * (colours[k, c] - inner[c])
    k = _split(scores, count, level)
    slope = _slope(scores, count, k, step)
    if slope < SLOPE_MIN or not scores[k] <= level < scores[k + 1]:
        return 0.0, 0.0
    place = k + (level - scores[k]) / (scores[k + 1] - scores[k])
    return (place - count // 2) * step, slope


@njit(cache=True, nogil=True)
def _exactly(
    yuyv: NDArray[np.uint8],
    x: float,
    y: float,
    normal: NDArray[np.float64],
    slope: float,
    plateaus: NDArray[np.float64],
    shares: NDArray[np.float64],
    pairs: NDArray[np.float64],
) -> tuple[float, float]:
    """Shift of an edge found at (x, y) to where it exactly is, and the information about it."""
    gathered2 = GATHERED2 * normal[0] ** 2 + 0.2 * normal[1] ** 2
    width = math.sqrt(max(1.0 / slope**2 - 12.0 * gathered2, 1.0))
    return place_edge(
        yuyv, x, y, normal[0], normal[1], width, plateaus[0], plateaus[2], shares, pairs
    )


@njit(cache=True, nogil=True)
def measure(
    yuyv: NDArray[np.uint8],
    places: NDArray[np.float64],
    normals: NDArray[np.float64],
    count: int,
    reach: float,
    step: float,
    depth: float,
    exact: bool,
    found: NDArray[np.float64],
) -> None:
    """What `measure_edges` says of the first `count` places, into the columns of `found` (n, 4).

    step: px between samples of a profile; coarser ones do where edges are only looked for.
    """
    height, width = yuyv.shape[0], yuyv.shape[1]
    reach = min(reach, (SAMPLES_MAX // 2) * step)
    colours, scores = np.empty((SAMPLES_MAX, 3)), np.empty(SAMPLES_MAX)
    plateaus, shares, pairs = np.empty((3, 3)), np.empty(SHARES), np.empty((PAIRS_MAX, 3))
    for i in range(count):
        nx, ny = normals[i, 0], normals[i, 1]
        x, y = places[i, 0] + reach * nx, places[i, 1] + reach * ny
        found[i, SIGMA] = np.inf
        found[i, WITHIN] = 0.0 <= x <= width - 1.0 and 0.0 <= y <= height - 1.0
        if not found[i, WITHIN]:
            continue
        samples = _profile(yuyv, places[i], normals[i], reach, step, depth, colours)
        contrast = _separation(colours, samples, plateaus[0], plateaus[1], plateaus[2])
        if contrast < CONTRAST_MIN:
            continue
        mixture_scores(plateaus[0], plateaus[1], plateaus[2], shares)
        half = shares[SHARES // 2]
        offset, slope = _crossing(colours, samples, plateaus[0], plateaus[2], half, step, scores)
        if slope == 0.0:
            continue
        information = slope * slope
        if exact and slope > SLOPE_EXACT:
            x, y = places[i, 0] + offset * nx, places[i, 1] + offset * ny
            shift, information = _exactly(yuyv, x, y, normals[i], slope, plateaus, shares, pairs)
            offset += shift
        if information > 0.0:
            found[i, OFFSET], found[i, WIDTH] = offset, 1.0 / slope
            found[i, SIGMA] = 1.0 / (contrast * math.sqrt(information))


def measure_edges(
    yuyv: NDArray[np.uint8],
    places_px: NDArray[np.float64],
    normals: NDArray[np.float64],
    reach_px: float,
    depth_px: float,
    exact: bool = True,
) -> Edges:
    """Look for the edge of the object across each place.

    places_px, normals: (n, 2), unit normals outwards, of the picture (H, W, 2) uint8. reach_px:
    how far to look on either side; depth_px: how far inside the object surely goes on. exact:
    put each where its pixels say, not only where its profile is half-way.
    """
    found = np.zeros((len(places_px), 4))
    measure(
        np.ascontiguousarray(yuyv),
        np.ascontiguousarray(places_px),
        np.ascontiguousarray(normals),
        len(places_px),
        reach_px,
        STEP_PX,
        depth_px,
        exact,
        found,
    )
    return Edges(
        offset_px=found[:, OFFSET],
        sigma_px=found[:, SIGMA],
        width_px=found[:, WIDTH],
        within=found[:, WITHIN] > 0.0,
        seen=np.isfinite(found[:, SIGMA]),
    )
