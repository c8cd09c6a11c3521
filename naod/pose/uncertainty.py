"""Covariance of a fitted pose: noise of the edge points, and what whole edges have in common."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.geometry.linear import invert_symmetric
from naod.pose.contour import CYLINDER, figures
from naod.pose.objects import ObjectShape
from naod.pose.reading import Reading

VAGUE = 1.0
"""Information there is without looking: to a metre and a radian."""

WEIGHTED = 1.27
"""Variance of an estimate with Geman-McClure weights at OUTLIER deviations of normal noise, over
what the weighted residuals give as if the weights had been known beforehand."""

BLOCK, BLOCKS_MIN = 5, 8
OUTLYING = 25.0
EXPECTED_BLOCKS = 10.0
"""Stretches whose agreement is taken for granted: a few of them alone say little."""

DEGREES = 6.0

FLOOR, COMMON, EDGE, PER_POINT = range(4)


@dataclass(frozen=True, slots=True)
class EdgeNoise:
    """How wrong edge points are, in pixels.

    `floor_px`: least standard deviation of one point. `common_px`: the whole outline too wide or
    too narrow. `edge_px`: each edge by itself. `per_point`: neighbours that err together.
    `fits_px`: a point further away belongs to something else.
    """

    floor_px: float
    common_px: float
    edge_px: float
    per_point: float
    fits_px: float

    @property
    def figures(self) -> NDArray[np.float64]:
        """(4,) as the kernel takes them."""
        return np.array([self.floor_px, self.common_px, self.edge_px, self.per_point])


@njit(cache=True, nogil=True)
def point_sigma(
    residuals: NDArray[np.float64],
    weights: NDArray[np.float64],
    trust: NDArray[np.float64],
    floor: float,
) -> float:
    """Standard deviation of an edge point of full trust, from residuals (n,), in their unit.

    weights: (n,) after down-weighting outliers. trust: (n,) as the points come.
    """
    squares = total = 0.0
    for i in range(residuals.size):
        squares += weights[i] * trust[i] * residuals[i] * residuals[i]
        total += weights[i]
    return max(floor, math.sqrt(WEIGHTED * squares / max(total - DEGREES, 1.0)))


@njit(cache=True, nogil=True)
def misfit_ratio(
    residuals: NDArray[np.float64],
    weights: NDArray[np.float64],
    trust: NDArray[np.float64],
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
            mean += weights[i] * math.sqrt(trust[i]) * residuals[i] / sigma
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
def stated(
    kind: int,
    T: NDArray[np.float64],
    residuals: NDArray[np.float64],
    jacobian: NDArray[np.float64],
    edges: NDArray[np.int64],
    weights: NDArray[np.float64],
    trust: NDArray[np.float64],
    noise: NDArray[np.float64],
) -> NDArray[np.float64]:
    """(6, 6) of translation (m) and rotation (rad) along the camera's axes, of a pose (3, 4).

    residuals, jacobian: px. noise: (4,) `EdgeNoise.figures`. The turn of a cylinder about its own
    axis is fixed by convention and has no variance.
    """
    sigma = point_sigma(residuals, weights, trust, noise[FLOOR])
    information, pulls, pull = np.zeros((6, 6)), np.zeros((4, 6)), np.zeros(6)
    for i in range(residuals.size):
        weight = weights[i] * trust[i] / (sigma * sigma)
        for j in range(6):
            pulls[edges[i], j] += weight * jacobian[i, j]
            for k in range(6):
                information[j, k] += weight * jacobian[i, j] * jacobian[i, k]
    stiff = 1e6 * (information[3, 3] + information[4, 4] + information[5, 5])
    for j in range(6):
        information[j, j] += VAGUE
        if kind == CYLINDER and j >= 3:
            for k in range(3):
                information[j, 3 + k] += stiff * T[j - 3, 1] * T[k, 1]
    inverse = np.empty((6, 6))
    # with VAGUE it is positive definite
    invert_symmetric(information, inverse)
    ratio = noise[PER_POINT] * misfit_ratio(residuals, weights, trust, sigma)
    total = ratio * inverse
    for edge in range(4):
        _add_shared(inverse, pulls[edge], noise[EDGE], total)
        pull += pulls[edge]
    _add_shared(inverse, pull, noise[COMMON], total)
    return total


def covariance(reading: Reading, shape: ObjectShape, noise: EdgeNoise) -> NDArray[np.float64]:
    """`stated` of a reading."""
    fit = reading.fit
    T = np.ascontiguousarray(fit.T_camera_object[:3])
    return stated(
        figures(shape)[0], T, fit.residuals, fit.jacobian, fit.edges, fit.weights, reading.trust,
        noise.figures,
    )  # fmt: skip
