"""Where an edge lies, to a fraction of a pixel, at full resolution, along given normals.

Along each normal the colour goes from one plateau to another. The profile is projected on the
direction that separates the two best, the changes of brightness that shading makes inside counted
as noise; where it is that of half the light of either lies the edge, roughly. `placing` then puts
it exactly, first each by itself, then knowing over how many pixels the others mix light.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.alike import (
    COLUMNS,
    CONTRAST,
    DIRECTION,
    GOES,
    INNER,
    KEPT,
    OFFSET,
    SIGMA,
    UNEVEN,
    WIDTH,
    WITHIN,
    place_alike,
    put_edge,
    seeming_px,
)
from naod.perception.encoding import mixture_scores
from naod.perception.placing import PAIRS_MAX, SHARES
from naod.perception.profile import contrast_of, is_between, is_of, outer_side, plateau, profile
from naod.perception.steps import crossing, goes_to, unevenness, width_of

STEP_PX = 0.5
SAMPLES_MAX = 129
FEW_SHARES = 5
"""Mixtures of two colours that are asked for where edges are only looked for."""

WIDTH_MAX_PX = 25.0
"""Where light mixes over more pixels than this, their number is too large to matter."""

PACE_FROM_PX = 6.0
"""Shorter motions leave no beginning of a step to look at."""

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
    mixings: NDArray[np.float64],
    groups: NDArray[np.int64],
    found: NDArray[np.float64],
) -> None:
    """What `measure_edges` says of the first `count` places, into `found` (n, COLUMNS).

    reaches: (n,) px. plateau_px: the outermost of a profile, on either side, that is one colour.
    step: px between samples of a profile; coarser ones do where edges are only looked for.
    palette: (m, 3) colours of the object, of which the inner side must be one; none: any. mixings:
    (n,) px over which motion is expected to mix light. groups: (n,) which edge each is of; even
    ones are along one direction, odd ones along another.
    """
    height, width = yuyv.shape[0], yuyv.shape[1]
    colours, scores = np.empty((SAMPLES_MAX, 3)), np.empty(SAMPLES_MAX)
    plateaus, scatter = np.empty((3, 3)), np.empty((3, 3))
    curves, pairs = np.empty((count, SHARES)), np.empty((PAIRS_MAX, 3))
    kept = np.zeros((count, KEPT))
    few, shares = max(int(plateau_px / step), 2), SHARES if exact else FEW_SHARES
    for i in range(count):
        normal, one, curve = normals[i], found[i], curves[i, :shares]
        reach = min(reaches[i], (SAMPLES_MAX // 2) * step)
        x, y = places[i, 0] + reach * normal[0], places[i, 1] + reach * normal[1]
        one[SIGMA] = np.inf
        one[WITHIN] = 0.0 <= x <= width - 1.0 and 0.0 <= y <= height - 1.0
        if not one[WITHIN]:
            continue
        samples = profile(yuyv, places[i], normal, reach, step, depth, colours)
        contrast, end = _sides(colours, samples, few, exact, palette, plateaus, scatter)
        if contrast == 0.0:
            continue
        mixture_scores(plateaus[0], plateaus[1], plateaus[2], curve)
        half = curve[shares // 2]
        at, slope = crossing(colours, end, plateaus[0], plateaus[2], half, step, scores)
        if slope == 0.0:
            continue
        one[OFFSET] = (at - samples // 2) * step
        one[WIDTH] = width_of(scores, end, at, slope, curve, step)
        one[UNEVEN] = unevenness(scores, end, few, step)
        if not exact or one[WIDTH] >= WIDTH_MAX_PX:
            one[SIGMA] = one[WIDTH] / contrast
            continue
        if mixings[i] > PACE_FROM_PX:
            one[GOES] = goes_to(scores, end, at, curve, step, mixings[i])
        kept[i, CONTRAST] = contrast
        kept[i, INNER:DIRECTION], kept[i, DIRECTION:KEPT] = plateaus[0], plateaus[2]
        seeming = seeming_px(normal, one[WIDTH])
        put_edge(yuyv, places[i], normal, seeming, 0.0, curve, pairs, kept[i], one)
    if exact:
        place_alike(yuyv, places, normals, count, groups, curves, pairs, kept, found)


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
        np.zeros(count),
        np.zeros(count, dtype=np.int64),
        found,
    )
    return Edges(
        offset_px=found[:, OFFSET],
        sigma_px=found[:, SIGMA],
        width_px=found[:, WIDTH],
        within=found[:, WITHIN] > 0.0,
        seen=np.isfinite(found[:, SIGMA]),
    )
