"""Which of several guesses leads to the poses that fit an outline best."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.pose.contour import CYLINDER
from naod.pose.convex import thinned
from naod.pose.fit import compare, descend
from naod.pose.guesses import face

READINGS = 2
"""A tilt towards the viewer and one away: more readings than these do not differ."""

POINTS, FEW_POINTS = 40, 16
STEPS, FEW_STEPS = 12, 4
SETTLED = 4e-3
CUT_GRAINS = 4.0
DISTINCT_RAD = 0.15
HOPELESS, HOPELESS_GRAINS2 = 4.0, 0.1
"""A guess that comes out so many times as bad as another, and a bit, is not followed."""

DEPTH_LEAST_M = 0.05
TILT_STD_RAD = 0.45
"""A can is seen level or from a little above, rarely from far above: where blur has rounded the
corners, its rims seem to bulge as they do from there."""

INDEPENDENT = 12.0
"""So many of the points of an outline err independently."""


@njit(cache=True, nogil=True)
def stand_up(kind: int, T: NDArray[np.float64]) -> bool:
    """The same outline with y towards the top of the picture; a can's z to the camera.

    False for a pose that cannot be, or that shows a board's back.
    """
    for i in range(3):
        for j in range(4):
            if not math.isfinite(T[i, j]):
                return False
    if kind == CYLINDER:
        axis = T[:, 1].copy()
        if axis[1] > 0.0:
            axis = -axis
        face(axis, T[:, 3].copy(), T)
    elif T[1, 1] > 0.0:
        for i in range(3):
            T[i, 0], T[i, 1] = -T[i, 0], -T[i, 1]
    towards = T[0, 2] * T[0, 3] + T[1, 2] * T[1, 3] + T[2, 2] * T[2, 3]
    return T[2, 3] > DEPTH_LEAST_M and towards < 0.0


@njit(cache=True, nogil=True)
def unlikeliness(kind: int, T: NDArray[np.float64]) -> float:
    """Squared standard deviations of a can's tilt at T (3, 4) from being seen level."""
    if kind != CYLINDER:
        return 0.0
    along = far2 = 0.0
    for k in range(3):
        along += T[k, 1] * T[k, 3]
        far2 += T[k, 3] ** 2
    tilt = math.asin(min(abs(along) / max(math.sqrt(far2), 1e-12), 1.0))
    return (tilt / TILT_STD_RAD) ** 2


@njit(cache=True, nogil=True)
def angle_between(A: NDArray[np.float64], B: NDArray[np.float64]) -> float:
    """Of the rotations of two poses (3, 4)."""
    trace = 0.0
    for i in range(3):
        for j in range(3):
            trace += A[i, j] * B[i, j]
    return math.acos(min(max(0.5 * (trace - 1.0), -1.0), 1.0))


@njit(cache=True, nogil=True)
def residuals_of(
    kind: int,
    half_width: float,
    half_height: float,
    T: NDArray[np.float64],
    points: NDArray[np.float64],
) -> NDArray[np.float64]:
    """(n,) distances of points from the outline at T (3, 4), on the plane z = 1."""
    n = points.shape[0]
    residuals, jacobian, edges = np.empty(n), np.empty((n, 6)), np.empty(n, dtype=np.int64)
    R, t = T[:, :3].copy(), T[:, 3].copy()
    corners = np.full(n, -1)
    compare(kind, half_width, half_height, R, t, points, corners, residuals, jacobian, edges)
    return residuals


@njit(cache=True, nogil=True)
def _descended(
    kind: int,
    half_width: float,
    half_height: float,
    T: NDArray[np.float64],
    points: NDArray[np.float64],
    grain: float,
    steps: int,
) -> float:
    """Moves T to where it fits; mean squared residual in grains, infinite if that is nowhere.

    More for a pose that is less likely: residuals are as large as they are, so by a factor.
    """
    n = points.shape[0]
    residuals, jacobian, edges = np.empty(n), np.empty((n, 6)), np.zeros(n, dtype=np.int64)
    weights = np.empty(n)
    descend(
        kind, half_width, half_height, T, points, np.ones(n), edges, np.zeros(4), 0.6 * grain,
        steps, SETTLED, residuals, jacobian, edges, weights, np.empty(4),
    )  # fmt: skip
    if not stand_up(kind, T):
        return np.inf
    total = 0.0
    for k in range(n):
        total += min(abs(residuals[k]) / grain, CUT_GRAINS) ** 2
    return total / n * math.exp(unlikeliness(kind, T) / INDEPENDENT)


@njit(cache=True, nogil=True)
def explore(
    kind: int,
    half_width: float,
    half_height: float,
    points: NDArray[np.float64],
    guesses: NDArray[np.float64],
    count: int,
    grain: float,
    poses: NDArray[np.float64],
) -> int:
    """Up to READINGS poses (READINGS, 3, 4) that fit points on the plane z = 1, the best first.

    guesses: (count, 3, 4) and more. grain: resolution of the points. A few of them for a few steps
    decide which guesses are followed to the end.
    """
    few, costs = thinned(points, max(1, points.shape[0] // FEW_POINTS)), np.empty(count)
    for k in range(count):
        costs[k] = _descended(kind, half_width, half_height, guesses[k], few, grain, FEW_STEPS)
    order, ends, found = np.argsort(costs), np.empty(READINGS), 0
    best = order[0]
    for k in order:
        if found == READINGS or not costs[k] < HOPELESS * costs[best] + HOPELESS_GRAINS2:
            break
        if found == 1 and angle_between(guesses[k], poses[0]) < DISTINCT_RAD:
            continue
        poses[found] = guesses[k]
        ends[found] = _descended(kind, half_width, half_height, poses[found], points, grain, STEPS)
        found += math.isfinite(ends[found])
    if found == 2 and ends[1] < ends[0]:
        first = poses[0].copy()
        poses[0] = poses[1]
        poses[1] = first
    return found
