"""Where an edge lies, to a fraction of a pixel, at full resolution, along given normals.

Along each normal the colour goes from one plateau to another. The profile is projected on the
direction that separates the two best, the changes of brightness that shading makes inside counted
as noise, and the edge lies where the projection is that of the colour expected at an edge: blur
widens the step without moving it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.geometry.linear import solve_symmetric
from naod.perception.encoding import SPREAD_CHROMA2, SPREAD_LUMA2, lights, mixed_colour

STEP_PX = 0.5
SAMPLES_MAX = 129
NOISE_LEVELS = 3.0
"""Standard deviation of one channel of one pixel, 8-bit levels."""

SHADING = 0.15
"""Relative standard deviation of brightness over a plateau inside."""

MIXING_MIN_PX = 1.2
"""Light mixes over at least a pixel's own width and what the sharpest lens adds."""

SLOPE_MIN = 0.02

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
def _mix(
    yuyv: NDArray[np.uint8], row: float, column: float, stride: int, offset: int, channel: int
) -> float:
    """Bilinear sample of one channel whose columns are `stride` apart from `offset` on."""
    height, columns = yuyv.shape[0], yuyv.shape[1] // stride
    row = min(max(row, 0.0), height - 1.0)
    column = min(max(column, 0.0), columns - 1.0)
    i, j = min(int(row), max(height - 2, 0)), min(int(column), max(columns - 2, 0))
    a, b = row - i, column - j
    below, beside = min(i + 1, height - 1), offset + stride * min(j + 1, columns - 1)
    here = offset + stride * j
    upper = (1.0 - b) * yuyv[i, here, channel] + b * yuyv[i, beside, channel]
    lower = (1.0 - b) * yuyv[below, here, channel] + b * yuyv[below, beside, channel]
    return (1.0 - a) * upper + a * lower


@njit(cache=True, nogil=True)
def _profile(
    yuyv: NDArray[np.uint8],
    place: NDArray[np.float64],
    normal: NDArray[np.float64],
    reach: float,
    depth: float,
    colours: NDArray[np.float64],
) -> int:
    """Colours from `reach` inside to `reach` outside; no deeper inside than `depth`."""
    count = 2 * int(reach / STEP_PX) + 1
    for k in range(count):
        s = max((k - count // 2) * STEP_PX, -depth)
        x, y = place[0] + s * normal[0], place[1] + s * normal[1]
        pair = (x - 0.5) / 2.0
        colours[k, 0] = _mix(yuyv, y, x, 1, 0, 0)
        colours[k, 1] = _mix(yuyv, y, pair, 2, 0, 1)
        colours[k, 2] = _mix(yuyv, y, pair, 2, 1, 1)
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
def _level_at_edge(
    inner: NDArray[np.float64],
    outer: NDArray[np.float64],
    direction: NDArray[np.float64],
    nx: float,
    slope: float,
    scratch: NDArray[np.float64],
) -> float:
    """Projection, 0 inside and 1 outside, of what is seen at the edge itself.

    `slope` of the projected profile, per pixel, tells how far the light mixes.
    """
    chroma2 = SPREAD_CHROMA2 * nx * nx + SPREAD_LUMA2 * (1.0 - nx * nx)
    gathered2 = 0.5 * (SPREAD_LUMA2 + chroma2)
    width = math.sqrt(max(1.0 / (slope * slope) - 12.0 * gathered2, MIXING_MIN_PX**2))
    lights(inner, scratch[0])
    lights(outer, scratch[1])
    mixed_colour(
        scratch[0], scratch[1], width, math.sqrt(SPREAD_LUMA2), math.sqrt(chroma2), scratch[2]
    )
    total = 0.0
    for c in range(3):
        total += direction[c] * (scratch[2, c] - inner[c])
    return min(max(total, 0.1), 0.9)


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
def _slope(scores: NDArray[np.float64], count: int, k: int) -> float:
    """Rise per pixel about the step after sample k; 0 where the profile ends too soon."""
    if k < 2 or k > count - 4:
        return 0.0
    return (scores[k + 3] - scores[k - 2]) / (5.0 * STEP_PX)


@njit(cache=True, nogil=True)
def _edge(
    colours: NDArray[np.float64],
    count: int,
    nx: float,
    scores: NDArray[np.float64],
    scratch: NDArray[np.float64],
) -> tuple[float, float, float]:
    """Place of the edge in a profile, in samples; its sigma, infinite if unseen; its width."""
    inner, outer, direction = scratch[0], scratch[1], scratch[2]
    contrast = _separation(colours, count, inner, outer, direction)
    if contrast < CONTRAST_MIN:
        return 0.0, np.inf, 0.0
    for k in range(count):
        scores[k] = 0.0
        for c in range(3):
            scores[k] += direction[c] * (colours[k, c] - inner[c])
    level = 0.5
    for _ in range(2):
        k = _split(scores, count, level)
        slope = _slope(scores, count, k)
        if slope < SLOPE_MIN or not scores[k] <= level <= scores[k + 1]:
            return 0.0, np.inf, 0.0
        level = _level_at_edge(inner, outer, direction, nx, slope, scratch[3:])
    while k > 0 and scores[k] > level:
        k -= 1
    while k < count - 2 and scores[k + 1] < level:
        k += 1
    step = scores[k + 1] - scores[k]
    if not step > 0.0:
        return 0.0, np.inf, 0.0
    return k + (level - scores[k]) / step, 1.0 / (contrast * slope), 1.0 / slope


@njit(cache=True, nogil=True)
def _measure(
    yuyv: NDArray[np.uint8],
    places: NDArray[np.float64],
    normals: NDArray[np.float64],
    reach: float,
    depth: float,
    offset: NDArray[np.float64],
    sigma: NDArray[np.float64],
    rise: NDArray[np.float64],
    within: NDArray[np.bool_],
    seen: NDArray[np.bool_],
) -> None:
    height, width = yuyv.shape[0], yuyv.shape[1]
    colours, scores = np.empty((SAMPLES_MAX, 3)), np.empty(SAMPLES_MAX)
    scratch = np.empty((6, 3))
    for i in range(places.shape[0]):
        seen[i], offset[i], sigma[i], rise[i] = False, 0.0, np.inf, 0.0
        x, y = places[i, 0] + reach * normals[i, 0], places[i, 1] + reach * normals[i, 1]
        within[i] = 0.0 <= x <= width - 1.0 and 0.0 <= y <= height - 1.0
        if not within[i]:
            continue
        count = _profile(yuyv, places[i], normals[i], reach, depth, colours)
        place, sigma[i], rise[i] = _edge(colours, count, normals[i, 0], scores, scratch)
        if sigma[i] < np.inf:
            offset[i] = (place - count // 2) * STEP_PX
            seen[i] = True


def measure_edges(
    yuyv: NDArray[np.uint8],
    places_px: NDArray[np.float64],
    normals: NDArray[np.float64],
    reach_px: float,
    depth_px: float,
) -> Edges:
    """Look for the edge of the object across each place.

    places_px, normals: (n, 2), unit normals outwards, of the picture (H, W, 2) uint8. reach_px:
    how far to look on either side; depth_px: how far inside the object surely goes on.
    """
    n = len(places_px)
    flags = np.empty((2, n), dtype=np.bool_)
    out = Edges(np.empty(n), np.empty(n), np.empty(n), flags[0], flags[1])
    reach = min(reach_px, (SAMPLES_MAX // 2) * STEP_PX)
    _measure(
        np.ascontiguousarray(yuyv),
        np.ascontiguousarray(places_px),
        np.ascontiguousarray(normals),
        reach,
        depth_px,
        out.offset_px,
        out.sigma_px,
        out.width_px,
        out.within,
        out.seen,
    )
    return out
