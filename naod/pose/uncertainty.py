"""Covariance of a fitted pose: noise of the edge points, and what whole edges have in common."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.geometry.linear import invert_symmetric
from naod.pose.contour import CYLINDER, figures
from naod.pose.noise import COMMON, EDGE, FLOOR, PER_POINT, EdgeNoise
from naod.pose.objects import ObjectShape
from naod.pose.reading import Reading
from naod.pose.shared import DEGREES, give_way, point_sigma

VAGUE = 1.0
"""Information there is without looking: to a metre and a radian."""

BLOCK, BLOCKS_MIN = 5, 8
OUTLYING = 25.0
EXPECTED_BLOCKS = 10.0
"""Stretches whose agreement is taken for granted: a few of them alone say little."""


@njit(cache=True, nogil=True)
def misfit_ratio(
    residuals: NDArray[np.float64],
    weights: NDArray[np.float64],
    trust: NDArray[np.float64],
    groups: NDArray[np.int64],
    offsets: NDArray[np.float64],
    sigma: float,
) -> float:
    """How much more the outline deviates in whole stretches than its points' noise explains.

    About 1 for a shape that is there as described; more for one that is not quite it, or is partly
    covered. Birge's ratio over stretches of BLOCK points (in order around the outline), each
    counted up to OUTLYING.
    """
    n = residuals.size
    blocks = max(BLOCKS_MIN, n // BLOCK)
    total = EXPECTED_BLOCKS
    for k in range(blocks):
        mean = spread = 0.0
        for i in range(k * n // blocks, (k + 1) * n // blocks):
            gap = residuals[i] - offsets[groups[i]]
            mean += weights[i] * math.sqrt(trust[i]) * gap / sigma
            spread += weights[i] * weights[i]
        if spread > 0.0:
            total += min(mean * mean / spread, OUTLYING)
    return max(total / (EXPECTED_BLOCKS + blocks - DEGREES), 1.0)


@njit(cache=True, nogil=True)
def _add_shared(
    inverse: NDArray[np.float64],
    pull: NDArray[np.float64],
    sigma: float,
    total: NDArray[np.float64],
) -> None:
    """What an offset common to some points does to the pose; pull (6,): theirs together."""
    response = np.zeros(6)
    for i in range(6):
        for j in range(6):
            response[i] += inverse[i, j] * pull[j]
    for i in range(6):
        for j in range(6):
            total[i, j] += sigma * sigma * response[i] * response[j]


@njit(cache=True, nogil=True)
def add_turn(t: NDArray[np.float64], sigma: float, total: NDArray[np.float64]) -> None:
    """Add to a covariance (6, 6), as `stated` has it, a turn of the camera about its x and its y.

    t: (3,) m, of the pose. sigma: standard deviation of the turn about either, rad.
    """
    moves = np.zeros((2, 6))
    moves[0, 1], moves[0, 2], moves[0, 3] = -t[2], t[1], 1.0
    moves[1, 0], moves[1, 2], moves[1, 4] = t[2], -t[0], 1.0
    for k in range(2):
        for i in range(6):
            for j in range(6):
                total[i, j] += sigma * sigma * moves[k, i] * moves[k, j]


@njit(cache=True, nogil=True)
def _hold(kind: int, T: NDArray[np.float64], information: NDArray[np.float64]) -> None:
    """Fill the upper half, add what is known without looking; a can's own turn is known."""
    stiff = 1e6 * (information[3, 3] + information[4, 4] + information[5, 5])
    for j in range(6):
        for k in range(j):
            information[k, j] = information[j, k]
    for j in range(6):
        information[j, j] += VAGUE
        if kind == CYLINDER and j >= 3:
            for k in range(3):
                information[j, 3 + k] += stiff * T[j - 3, 1] * T[k, 1]


@njit(cache=True, nogil=True)
def stated(
    kind: int,
    T: NDArray[np.float64],
    residuals: NDArray[np.float64],
    jacobian: NDArray[np.float64],
    groups: NDArray[np.int64],
    weights: NDArray[np.float64],
    trust: NDArray[np.float64],
    spreads: NDArray[np.float64],
    offsets: NDArray[np.float64],
    noise: NDArray[np.float64],
) -> NDArray[np.float64]:
    """(6, 6) of translation (m) and rotation (rad) along the camera's axes, of a pose (3, 4).

    residuals, jacobian: px. groups (n,), spreads and offsets (4,) px: as `descend` has them. noise:
    (9,) `EdgeNoise.figures`. The turn of a cylinder about its own axis is fixed by convention and
    has no variance.
    """
    sigma = point_sigma(residuals, weights, trust, groups, offsets, noise[FLOOR])
    ratio = noise[PER_POINT] * misfit_ratio(residuals, weights, trust, groups, offsets, sigma)
    sigma *= math.sqrt(ratio)
    information, rest, pull = np.zeros((6, 6)), np.zeros(6), np.zeros(6)
    pulls, sums, gains = np.zeros((4, 6)), np.zeros((2, 4)), np.zeros(4)
    for i in range(residuals.size):
        weight, edge = weights[i] * trust[i], groups[i]
        sums[0, edge] += weight
        sums[1, edge] += weight * residuals[i]
        for j in range(6):
            pulls[edge, j] += weight * jacobian[i, j]
            for k in range(j + 1):
                information[j, k] += weight * jacobian[i, j] * jacobian[i, k]
    give_way(pulls, sums[0], sums[1], spreads, sigma, offsets.copy(), gains, information, rest)
    information /= sigma * sigma
    _hold(kind, T, information)
    inverse = np.empty((6, 6))
    # with VAGUE it is positive definite
    invert_symmetric(information, inverse)
    total = inverse.copy()
    pulls /= sigma * sigma
    for edge in range(4):
        pull += pulls[edge] * (1.0 - gains[edge] * sums[0, edge])
        if gains[edge] == 0.0:
            # the fit took none of it for an offset
            _add_shared(inverse, pulls[edge], noise[EDGE], total)
    _add_shared(inverse, pull, noise[COMMON], total)
    return total


def covariance(reading: Reading, shape: ObjectShape, noise: EdgeNoise) -> NDArray[np.float64]:
    """`stated` of a reading."""
    fit = reading.fit
    T = np.ascontiguousarray(fit.T_camera_object[:3])
    return stated(
        figures(shape)[0], T, fit.residuals, fit.jacobian, fit.groups, fit.weights, reading.trust,
        fit.spreads, fit.offsets, noise.figures,
    )  # fmt: skip
