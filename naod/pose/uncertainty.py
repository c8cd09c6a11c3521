"""Covariance of a fitted pose: noise of the edge points, and what whole edges have in common."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from naod.pose.fit import Fit
from naod.pose.objects import Cylinder, ObjectShape
from naod.pose.search import Reading

VAGUE = np.diag([1.0, 1.0, 1.0, 1.0, 1.0, 1.0])
"""Information there is without looking: to a metre and a radian."""

WEIGHTED = 1.27
"""Variance of an estimate with Geman-McClure weights at OUTLIER deviations of normal noise, over
what the weighted residuals give as if the weights had been known beforehand."""

BLOCKS = 24
BLOCKS_MIN = 8
OUTLYING = 25.0


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

    def blurred(self, factor: float) -> EdgeNoise:
        """The same where steps are so many times as wide: more neighbours err together.

        Blur takes nothing from where an edge is on the whole, since it is symmetric.
        """
        return replace(self, per_point=self.per_point * factor, fits_px=self.fits_px * factor)


def point_sigma(fit: Fit, noise: EdgeNoise) -> float:
    """Standard deviation of one independent edge point, from the residuals, in pixels."""
    spare = max(float(fit.weights.sum()) - 6.0, 1.0)
    variance = WEIGHTED * float((fit.weights * fit.residuals**2).sum()) / spare
    return max(noise.floor_px, math.sqrt(variance))


def misfit_ratio(reading: Reading, noise: EdgeNoise) -> float:
    """How much more the outline deviates in whole stretches than its points' noise explains.

    1 for a shape that is there as described; more for one that is not quite it, or is partly
    covered. Birge's ratio over up to BLOCKS stretches, each counted up to OUTLYING.
    """
    fit, points = reading.fit, reading.outline.points_px
    x, y = (points - points.mean(axis=0)).T
    around = fit.residuals[np.argsort(np.arctan2(y, x))]
    count = min(BLOCKS, max(BLOCKS_MIN, len(around) // 4))
    blocks = np.array_split(around, count)
    middles = np.array([np.median(block) for block in blocks])
    sizes = np.array([len(block) for block in blocks])
    scatter = np.abs(around - np.repeat(middles, sizes))
    sigma = max(noise.floor_px, 1.4826 * float(np.median(scatter)))
    # a median scatters by a quarter more than a mean
    squares = middles**2 * sizes / (1.57 * sigma**2 * noise.per_point)
    return max(1.0, float(np.minimum(squares, OUTLYING).sum()) / (count - 6))


def covariance(reading: Reading, shape: ObjectShape, noise: EdgeNoise) -> NDArray[np.float64]:
    """(6, 6) of translation (m) and rotation (rad) along the camera's axes."""
    scattered, common = parts(reading, shape, noise)
    return scattered + common


def parts(
    reading: Reading, shape: ObjectShape, noise: EdgeNoise
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The covariance in two parts: of the points' noise, new in each picture, and of whole edges.

    The second is the same in every picture from one place: it does not average out. The turn of a
    cylinder about its own axis is fixed by convention and has no variance.
    """
    fit = reading.fit
    weights = fit.weights * reading.outline.trust
    weighted = fit.jacobian * (weights / (point_sigma(fit, noise) ** 2 * noise.per_point))[:, None]
    information = weighted.T @ fit.jacobian + VAGUE
    if isinstance(shape, Cylinder):
        axis = np.append(np.zeros(3), fit.T_camera_object[:3, 1])
        information += 1e6 * np.trace(information[3:, 3:]) * np.outer(axis, axis)
    inverse = np.linalg.inv(information)
    scattered = inverse * misfit_ratio(reading, noise)
    common = _shared(inverse, weighted, noise.common_px)
    for edge in np.unique(fit.edges):
        common += _shared(inverse, weighted[fit.edges == edge], noise.edge_px)
    return (scattered + scattered.T) / 2.0, (common + common.T) / 2.0


def _shared(
    inverse: NDArray[np.float64], weighted: NDArray[np.float64], sigma_px: float
) -> NDArray[np.float64]:
    """What an offset common to some points does to the pose."""
    response = inverse @ weighted.sum(axis=0)
    return np.outer(response, response) * sigma_px**2
