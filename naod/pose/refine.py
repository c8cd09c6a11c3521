"""From a rough pose to the picture's own edges and the pose that fits them, in kernels."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.edges import OFFSET, SIGMA, WIDTH, WITHIN, measure
from naod.pose.around import narrowest, places_around, seen_outline
from naod.pose.contour import VERTICES
from naod.pose.explore import READINGS, explore, residuals_of, stand_up
from naod.pose.fit import descend
from naod.pose.guesses import OTHERS_MAX, other_readings
from naod.pose.lens import focal, from_pixels

LOOKED, FOUND, BLUR, SPAN, MOVED = range(5)
TALLY = 5
"""Of a tally: places looked at, edges found there, width of the more blurred ones, and the
object's width, and how far most edges were from where they were looked for, px."""

PLACES_MAX = 128
WIDE_PLACES = 64
APART_PX = 2.0
"""Each edge is placed by pixels as far along it: closer ones would say the same again."""

WIDE = 0.2
"""How far from a blob's outline edges are looked for, of its width: shading hides as much of a can
from its colour."""

WIDE_GRAINS = 2.5
NEAR_PX = 4.0
"""How far from a good outline: the step and its plateaus."""

NEAR_RISES = 1.2
"""The same in widths of a blurred step."""

INSIDE = 0.4
"""Of the object's width: so far inside there is surely nothing else."""

BLURRED_SHARE = 0.8
"""Motion blurs the edges across it: the width of an edge that four of five do not reach."""

MOST_SHARE = 0.7
MOVED_PX = 1.0
LOOKS = 3
MISSED = 4.0
"""What an edge not seen counts as, in widths of a grain."""

EXPLAINED = 0.6
"""Mean distance of edges from an outline, in grains, at which no other is asked for its."""

WIDE_SAMPLES = 20
EDGE_FLOOR_PX = 0.05
WIDE_GRAIN_PX, FLOOR_PX = 0.5, 0.15
POINTS_MIN = 12
STEPS, SETTLED = 8, 1e-4
STEP_PX = 0.5


@njit(cache=True, nogil=True)
def look(
    yuyv: NDArray[np.uint8],
    kind: int,
    half_width: float,
    half_height: float,
    T: NDArray[np.float64],
    lens: NDArray[np.float64],
    most: int,
    reach: float,
    reach_share: float,
    exact: bool,
    points: NDArray[np.float64],
    sigmas: NDArray[np.float64],
    looked: NDArray[np.int64],
    tally: NDArray[np.float64],
) -> int:
    """Edges of the picture near the outline at T (3, 4); returns how many.

    points (most, 2) and sigmas (most,) in px. looked (4,): places the picture shows of each edge.
    Near is `reach` px, or `reach_share` of the object's width if that is more. exact: as
    `measure_edges` has it.
    """
    image, names = np.empty((VERTICES, 3)), np.empty(VERTICES, dtype=np.int64)
    places, normals = np.empty((most, 2)), np.empty((most, 2))
    edges, found = np.empty(most, dtype=np.int64), np.zeros((most, 4))
    pieces = seen_outline(kind, half_width, half_height, T, image, names)
    span = focal(lens) * narrowest(image, pieces)
    count = places_around(image, names, pieces, lens, most, APART_PX, places, normals, edges)
    reach = max(reach, reach_share * span)
    step = STEP_PX if exact else max(STEP_PX, reach / WIDE_SAMPLES)
    measure(yuyv, places, normals, count, reach, step, INSIDE * span, exact, found)
    seen, widths, moves = 0, np.empty(count), np.empty(count)
    looked[:] = 0
    for i in range(count):
        if found[i, WITHIN] > 0.0:
            looked[edges[i]] += 1
        if not np.isfinite(found[i, SIGMA]):
            continue
        for c in range(2):
            points[seen, c] = places[i, c] + found[i, OFFSET] * normals[i, c]
        sigmas[seen], widths[seen] = found[i, SIGMA], found[i, WIDTH]
        moves[seen] = abs(found[i, OFFSET])
        seen += 1
    tally[LOOKED], tally[FOUND], tally[SPAN] = looked.sum(), seen, span
    tally[BLUR] = np.sort(widths[:seen])[int(BLURRED_SHARE * seen)] if seen else 0.0
    tally[MOVED] = np.sort(moves[:seen])[int(MOST_SHARE * seen)] if seen else 0.0
    return seen


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
    looked, counted = np.empty(4, dtype=np.int64), np.empty(TALLY)
    guesses, found = np.empty((OTHERS_MAX, 3, 4)), np.empty((READINGS, 3, 4))
    wide, best, made = max(WIDE_GRAINS * grain_px, NEAR_PX), np.inf, 0
    starts = poses[:count].copy()
    for k in range(count):
        seen = look(
            yuyv, kind, half_width, half_height, starts[k], lens, WIDE_PLACES, wide, WIDE, False,
            points, sigmas, looked, counted,
        )  # fmt: skip
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
    points: NDArray[np.float64],
    sigmas: NDArray[np.float64],
    looked: NDArray[np.int64],
    tally: NDArray[np.float64],
    residuals: NDArray[np.float64],
    jacobian: NDArray[np.float64],
    edges: NDArray[np.int64],
    weights: NDArray[np.float64],
    trust: NDArray[np.float64],
) -> int:
    """Moves T (3, 4) to fit the edges close to its outline, placed exactly; returns how many.

    Once more from there where they were not so close. `tally` tells of the look before; the other
    arrays, PLACES_MAX long, are filled as in `look` and `fit_edges`. 0: no pose.
    """
    seen = 0
    for _ in range(LOOKS):
        near = max(NEAR_PX, NEAR_RISES * tally[BLUR])
        seen = look(
            yuyv, kind, half_width, half_height, T, lens, PLACES_MAX, near, 0.0, True,
            points, sigmas, looked, tally,
        )  # fmt: skip
        if seen < POINTS_MIN:
            return 0
        if not fit_edges(
            kind, half_width, half_height, T, points[:seen], sigmas[:seen], lens,
            residuals[:seen], jacobian[:seen], edges[:seen], weights[:seen], trust[:seen],
        ):  # fmt: skip
            return 0
        if tally[MOVED] < MOVED_PX:
            break
    return seen


@njit(cache=True, nogil=True)
def fit_edges(
    kind: int,
    half_width: float,
    half_height: float,
    T: NDArray[np.float64],
    points: NDArray[np.float64],
    sigmas: NDArray[np.float64],
    lens: NDArray[np.float64],
    residuals: NDArray[np.float64],
    jacobian: NDArray[np.float64],
    edges: NDArray[np.int64],
    weights: NDArray[np.float64],
    trust: NDArray[np.float64],
) -> bool:
    """Moves T (3, 4) to where it fits edge points (n, 2) px; the rest as in `compare`, in px.

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
        kind, half_width, half_height, T, on_plane, trust, FLOOR_PX / scale, STEPS, SETTLED,
        residuals, jacobian, edges, weights,
    )  # fmt: skip
    for i in range(n):
        residuals[i] *= scale
        for k in range(6):
            jacobian[i, k] *= scale
    before = T[1, 1]
    stands = stand_up(kind, T)
    if before * T[1, 1] < 0.0:
        for i in range(n):
            edges[i] = (edges[i] + 2) % 4
    return stands
