"""From a pose to the edges close to its outline, and the pose that fits them, in kernels."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.pose.explore import stand_up
from naod.pose.fit import descend
from naod.pose.lens import focal, from_pixels
from naod.pose.looking import look
from naod.pose.noise import EDGE, PER_BLUR, PER_ODD, PER_RISE
from naod.pose.tally import (
    MOVED,
    ODD_SIDES,
    RISE,
    RISE_ASIDE,
    SHARP_RISE_PX,
    UNEVEN_SIDES,
    aliased,
    mixed_px,
)

PLACES_MAX = 80
POINTS_MIN = 12
MOVED_PX, GREW = 1.0, 1.4
"""An outline that has moved further, and steps that are so much wider than was thought, are looked
at again."""

LOOKS = 3
EVEN = 0.008
"""Rise of a side per px, of the step's, that shading and noise make."""

ALONG = 0.2
"""Motion along an edge rounds its ends: what that counts for, of motion across it."""

EDGE_FLOOR_PX, FLOOR_PX = 0.05, 0.15
STEPS, SETTLED = 8, 1e-4


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
    """How far each edge (4,) may be off as a whole, px, by what its steps are like."""
    for edge in range(4):
        mixed = mixed_px(tally[RISE + edge % 2], SHARP_RISE_PX)
        along = ALONG * mixed_px(tally[RISE + 1 - edge % 2], SHARP_RISE_PX)
        uneven = max(tally[UNEVEN_SIDES + edge] - EVEN, 0.0)
        rising = noise[PER_RISE] * uneven * mixed
        blurred = math.hypot(noise[PER_BLUR] * math.hypot(mixed, along), rising)
        odd = noise[PER_ODD] * tally[ODD_SIDES + edge]
        spreads[edge] = math.hypot(noise[EDGE] * aliased(mixed), math.hypot(blurred, odd))


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
