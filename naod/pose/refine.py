"""From a rough pose to the picture's own edges and the pose that fits them, in kernels."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.pose.explore import (
    INDEPENDENT,
    READINGS,
    explore,
    residuals_of,
    stand_up,
    unlikeliness,
)
from naod.pose.fit import descend
from naod.pose.guesses import OTHERS_MAX, other_readings
from naod.pose.lens import focal, from_pixels
from naod.pose.looking import (
    LOOKED,
    MOVED,
    RISE,
    RISE_ASIDE,
    SHARP_RISE_PX,
    SPAN,
    TALLY,
    UNEVEN_SIDES,
    WIDE,
    aliased,
    look,
    mixed_px,
)
from naod.pose.noise import EDGE, PER_BLUR, PER_RISE

PLACES_MAX = 80
WIDE_PLACES = 48
WIDE_GRAINS, WIDE_PX = 2.5, 4.0
MOVED_PX, GREW = 1.0, 1.4
"""An outline that has moved further, and steps that are so much wider than was thought, are looked
at again."""

WIDE_LOOKS = 2
SEEN_WHOLE, REACH_RISES = 0.8, 1.2
"""Wider than so much of the way looked, a step may be wider still; a look over so many of its
widths tells."""

LOOKS = 3
MISSED = 4.0
"""What an edge not seen counts as, in widths of a grain."""

EXPLAINED = 0.6
"""Mean distance of edges from an outline, in grains, at which no other is asked for its."""

EVEN = 0.008
"""Rise of a side per px, of the step's, that shading and noise make."""

EDGE_FLOOR_PX = 0.05
WIDE_GRAIN_PX, FLOOR_PX = 0.5, 0.15
POINTS_MIN = 12
STEPS, SETTLED = 8, 1e-4


@njit(cache=True, nogil=True)
def find_readings(
    yuyv: NDArray[np.uint8],
    kind: int,
    half_width: float,
    half_height: float,
    poses: NDArray[np.float64],
    count: int,
    grain_px: float,
    lens: NDArray[np.float64],
    tally: NDArray[np.float64],
) -> int:
    """Readings of the edges found widely about poses (READINGS, 3, 4); returns how many there are.

    The `count` poses given are replaced, the best first. Each is asked for the edges about it,
    since those about a wrong one are not all the object's. `tally` is that of the best's.
    """
    points, sigmas = np.empty((WIDE_PLACES, 2)), np.empty(WIDE_PLACES)
    groups = np.empty(WIDE_PLACES, dtype=np.int64)
    looked, counted = np.empty(4, dtype=np.int64), np.empty(TALLY)
    guesses, found = np.empty((OTHERS_MAX, 3, 4)), np.empty((READINGS, 3, 4))
    wide, best, made = max(WIDE_GRAINS * grain_px, WIDE_PX), np.inf, 0
    starts = poses[:count].copy()
    for k in range(count):
        reach = wide
        for _ in range(WIDE_LOOKS):
            seen = look(
                yuyv, kind, half_width, half_height, starts[k], lens, WIDE_PLACES, reach, points,
                sigmas, groups, looked, counted,
            )  # fmt: skip
            most = max(counted[RISE], counted[RISE_ASIDE])
            if most < SEEN_WHOLE * max(reach, WIDE * counted[SPAN]):
                break
            reach = REACH_RISES * most
        if seen < POINTS_MIN:
            continue
        on_plane = np.empty((seen, 2))
        from_pixels(lens, points[:seen], on_plane)
        started = other_readings(kind, half_width, half_height, starts[k], guesses)
        grain = WIDE_GRAIN_PX / focal(lens)
        several = explore(kind, half_width, half_height, on_plane, guesses, started, grain, found)
        if several == 0:
            continue
        worth, missed = 0.0, counted[LOOKED] - seen
        residuals = residuals_of(kind, half_width, half_height, found[0], on_plane)
        for i in range(seen):
            worth += min(abs(residuals[i]) / grain, MISSED)
        worth = (worth + MISSED * missed) / counted[LOOKED]
        worth *= math.exp(0.5 * unlikeliness(kind, found[0]) / INDEPENDENT)
        if worth < best:
            best, made = worth, several
            poses[:several], tally[:] = found[:several], counted
        if best < EXPLAINED:
            break
    return made


@njit(cache=True, nogil=True)
def find_edges(
    yuyv: NDArray[np.uint8],
    kind: int,
    half_width: float,
    half_height: float,
    T: NDArray[np.float64],
    lens: NDArray[np.float64],
    noise: NDArray[np.float64],
    points: NDArray[np.float64],
    sigmas: NDArray[np.float64],
    groups: NDArray[np.int64],
    looked: NDArray[np.int64],
    tally: NDArray[np.float64],
    residuals: NDArray[np.float64],
    jacobian: NDArray[np.float64],
    edges: NDArray[np.int64],
    weights: NDArray[np.float64],
    trust: NDArray[np.float64],
    spreads: NDArray[np.float64],
    offsets: NDArray[np.float64],
) -> int:
    """Moves T (3, 4) to fit the edges close to its outline, placed exactly; returns how many.

    Once more from there where they were not so close. `tally` tells of the look before; the other
    arrays, PLACES_MAX long, are filled as in `look` and `fit_edges`. 0: no pose.
    """
    seen = 0
    for _ in range(LOOKS):
        rise, rise_aside = tally[RISE], tally[RISE_ASIDE]
        seen = look(
            yuyv, kind, half_width, half_height, T, lens, PLACES_MAX, 0.0, points, sigmas, groups,
            looked, tally,
        )  # fmt: skip
        if seen < POINTS_MIN:
            return 0
        edge_spreads(noise, tally, spreads)
        if not fit_edges(
            kind, half_width, half_height, T, points[:seen], sigmas[:seen], groups[:seen],
            lens, spreads, residuals[:seen], jacobian[:seen], edges[:seen], weights[:seen],
            trust[:seen], offsets,
        ):  # fmt: skip
            return 0
        wider = tally[RISE] > GREW * rise or tally[RISE_ASIDE] > GREW * rise_aside
        if tally[MOVED] < MOVED_PX and not wider:
            break
    return seen


@njit(cache=True, nogil=True)
def edge_spreads(
    noise: NDArray[np.float64], tally: NDArray[np.float64], spreads: NDArray[np.float64]
) -> None:
    """How far each edge (4,) may be off as a whole, px, by how wide and even its steps are."""
    for edge in range(4):
        mixed = mixed_px(tally[RISE + edge % 2], SHARP_RISE_PX)
        uneven = max(tally[UNEVEN_SIDES + edge] - EVEN, 0.0)
        blurred = mixed * (noise[PER_BLUR] + noise[PER_RISE] * uneven)
        spreads[edge] = math.hypot(noise[EDGE] * aliased(mixed), blurred)


@njit(cache=True, nogil=True)
def fit_edges(
    kind: int,
    half_width: float,
    half_height: float,
    T: NDArray[np.float64],
    points: NDArray[np.float64],
    sigmas: NDArray[np.float64],
    groups: NDArray[np.int64],
    lens: NDArray[np.float64],
    spreads: NDArray[np.float64],
    residuals: NDArray[np.float64],
    jacobian: NDArray[np.float64],
    edges: NDArray[np.int64],
    weights: NDArray[np.float64],
    trust: NDArray[np.float64],
    offsets: NDArray[np.float64],
) -> bool:
    """Moves T (3, 4) to where it fits edge points (n, 2) px; the rest as in `descend`, in px.

    `weights` (n,) are after down-weighting outliers, `trust` (n,) by the points' own sigmas. False
    where there is no pose.
    """
    n, scale = points.shape[0], focal(lens)
    on_plane = np.empty((n, 2))
    from_pixels(lens, points, on_plane)
    for i in range(n):
        trust[i] = 1.0 / (EDGE_FLOOR_PX**2 + sigmas[i] ** 2)
    most = trust.max()
    for i in range(n):
        trust[i] /= most
    descend(
        kind, half_width, half_height, T, on_plane, trust, groups, spreads / scale,
        FLOOR_PX / scale, STEPS, SETTLED, residuals, jacobian, edges, weights, offsets,
    )  # fmt: skip
    for i in range(n):
        residuals[i] *= scale
        for k in range(6):
            jacobian[i, k] *= scale
    for k in range(4):
        offsets[k] *= scale
    before = T[1, 1]
    stands = stand_up(kind, T)
    if before * T[1, 1] < 0.0:
        for i in range(n):
            edges[i] = (edges[i] + 2) % 4
    return stands
