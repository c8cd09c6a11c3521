"""From rough poses to the readings of the edges found widely about them, in kernels."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.pose.explore import INDEPENDENT, READINGS, explore, residuals_of, unlikeliness
from naod.pose.guesses import OTHERS_MAX, other_readings
from naod.pose.lens import focal, from_pixels
from naod.pose.looking import WIDE, look
from naod.pose.refine import POINTS_MIN
from naod.pose.tally import LOOKED, RISE, RISE_ASIDE, SPAN, TALLY

WIDE_PLACES = 48
WIDE_GRAINS, WIDE_PX = 2.5, 4.0
WIDE_LOOKS = 2
SEEN_WHOLE, REACH_RISES = 0.8, 1.2
"""Wider than so much of the way looked, a step may be wider still; a look over so many of its
widths tells."""

MISSED = 4.0
"""What an edge not seen counts as, in widths of a grain."""

EXPLAINED = 0.6
"""Mean distance of edges from an outline, in grains, at which no other is asked for its."""

WIDE_GRAIN_PX = 0.5


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
