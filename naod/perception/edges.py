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

from naod.perception.encoding import mixture_scores
from naod.perception.placing import PAIRS_MAX, SHARES, place_edge
from naod.perception.profile import contrast_of, is_between, is_of, outer_side, plateau, profile

STEP_PX = 0.5
SAMPLES_MAX = 129
GATHERED2 = 0.9
"""Variance that shared chroma and bilinear samples add to a profile along a row, px squared."""

OFFSET, SIGMA, WIDTH, WITHIN, UNEVEN = range(5)
COLUMNS = 5
"""Of what is measured at a place; `UNEVEN`: by how much of the step the two sides rise per px."""


SLOPE_MIN = 0.02
SLOPE_EXACT = 0.04
"""Where light mixes over more pixels than this says, their number is too large to matter."""

SLOW_PX = 5.0
"""A step that seems to rise over more than this at its middle is asked how far its quarters are."""

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
    """Which sample of a profile, in fractions, is at a level, and its slope; slope 0 if none."""
    for k in range(count):
        scores[k] = 0.0
        for c in range(3):
            scores[k] += direction[c] * (colours[k, c] - inner[c])
    k = _split(scores, count, level)
    slope = _slope(scores, count, k, step)
    if slope < SLOPE_MIN or not scores[k] <= level < scores[k + 1]:
        return 0.0, 0.0
    place = k + (level - scores[k]) / (scores[k + 1] - scores[k])
    return place, slope


@njit(cache=True, nogil=True)
def _rise(
    scores: NDArray[np.float64], count: int, at: float, shares: NDArray[np.float64], step: float
) -> float:
    """Px over which light mixes, from where a quarter of it and three quarters are of one side."""
    lower, upper = shares[SHARES // 4], shares[SHARES - 1 - SHARES // 4]
    first, last = int(at), int(at) + 1
    while first > 0 and scores[first] > lower:
        first -= 1
    while last < count - 1 and scores[last] < upper:
        last += 1
    begin, end = float(first), float(last)
    if scores[first + 1] > scores[first]:
        begin += min(max((lower - scores[first]) / (scores[first + 1] - scores[first]), 0.0), 1.0)
    if scores[last] > scores[last - 1]:
        end -= min(max((scores[last] - upper) / (scores[last] - scores[last - 1]), 0.0), 1.0)
    return 2.0 * (end - begin) * step


@njit(cache=True, nogil=True)
def _unevenness(scores: NDArray[np.float64], count: int, few: int, step: float) -> float:
    """By how much of the step a profile's outermost few samples rise per px, both sides together.

    Sides that are not flat hide how far the step goes up or down.
    """
    half, rise = few // 2, 0.0
    for k in range(half):
        inner = scores[few - half + k] - scores[k]
        rise += scores[count - half + k] - scores[count - few + k] + inner
    return rise / (half * (few - half) * step)


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
def _sides(
    colours: NDArray[np.float64],
    count: int,
    few: int,
    outermost: bool,
    palette: NDArray[np.float64],
    plateaus: NDArray[np.float64],
    scatter: NDArray[np.float64],
) -> tuple[float, int]:
    """Contrast of the two sides of a profile and where the outer one ends; 0 where there is none.

    `plateaus` (3, 3): the inner and the outer colour and the direction that tells them apart.
    `few`: samples that a side is measured from. outermost: the outer side is at the profile's end,
    whatever lies between; else it is there only if the first step away from the inner colour goes
    on to it.
    """
    scatter[:] = 0.0
    plateau(colours, 0, few, plateaus[0], scatter)
    first = count - few
    if not outermost:
        step = outer_side(colours, count, few, plateaus[0])
        if step == count:
            return 0.0, count
        if not is_between(colours[step], plateaus[0], colours[count - few // 2 - 1]):
            first = step
    plateau(colours, first, first + few, plateaus[1], scatter)
    if not is_of(plateaus[0], plateaus[1], palette):
        return 0.0, count
    contrast = contrast_of(plateaus[0], plateaus[1], scatter, plateaus[2])
    return contrast if contrast >= CONTRAST_MIN else 0.0, first + few


@njit(cache=True, nogil=True)
def measure(
    yuyv: NDArray[np.uint8],
    places: NDArray[np.float64],
    normals: NDArray[np.float64],
    count: int,
    reaches: NDArray[np.float64],
    plateau_px: float,
    step: float,
    depth: float,
    palette: NDArray[np.float64],
    exact: bool,
    found: NDArray[np.float64],
) -> None:
    """What `measure_edges` says of the first `count` places, into `found` (n, COLUMNS).

    reaches: (n,) px. plateau_px: the outermost of a profile, on either side, that is one colour.
    step: px between samples of a profile; coarser ones do where edges are only looked for.
    palette: (m, 3) colours of the object, of which the inner side must be one; none: any.
    """
    height, width = yuyv.shape[0], yuyv.shape[1]
    colours, scores = np.empty((SAMPLES_MAX, 3)), np.empty(SAMPLES_MAX)
    plateaus, scatter = np.empty((3, 3)), np.empty((3, 3))
    shares, pairs = np.empty(SHARES), np.empty((PAIRS_MAX, 3))
    few = max(int(plateau_px / step), 2)
    for i in range(count):
        nx, ny = normals[i, 0], normals[i, 1]
        reach = min(reaches[i], (SAMPLES_MAX // 2) * step)
        x, y = places[i, 0] + reach * nx, places[i, 1] + reach * ny
        found[i, SIGMA] = np.inf
        found[i, WITHIN] = 0.0 <= x <= width - 1.0 and 0.0 <= y <= height - 1.0
        if not found[i, WITHIN]:
            continue
        samples = profile(yuyv, places[i], normals[i], reach, step, depth, colours)
        contrast, end = _sides(colours, samples, few, exact, palette, plateaus, scatter)
        if contrast == 0.0:
            continue
        mixture_scores(plateaus[0], plateaus[1], plateaus[2], shares)
        half = shares[SHARES // 2]
        at, slope = _crossing(colours, end, plateaus[0], plateaus[2], half, step, scores)
        if slope == 0.0:
            continue
        if 1.0 / slope > SLOW_PX:
            slope = 1.0 / max(_rise(scores, end, at, shares, step), SLOW_PX)
        offset, information = (at - samples // 2) * step, slope * slope
        if exact and slope > SLOPE_EXACT:
            x, y = places[i, 0] + offset * nx, places[i, 1] + offset * ny
            shift, information = _exactly(yuyv, x, y, normals[i], slope, plateaus, shares, pairs)
            offset += shift
        if information > 0.0:
            found[i, OFFSET], found[i, WIDTH] = offset, 1.0 / slope
            found[i, UNEVEN] = _unevenness(scores, end, few, step)
            found[i, SIGMA] = 1.0 / (contrast * math.sqrt(information))


_ANY = np.empty((0, 3))


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
    count = len(places_px)
    found = np.zeros((count, COLUMNS))
    measure(
        np.ascontiguousarray(yuyv),
        np.ascontiguousarray(places_px),
        np.ascontiguousarray(normals),
        count,
        np.full(count, reach_px),
        0.5 * reach_px,
        STEP_PX,
        depth_px,
        _ANY,
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
