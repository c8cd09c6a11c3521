"""How well a group of regions agrees with where the object is expected."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.finding.measure import METRE, X, Y
from naod.finding.presence import FARTHEST_M, NEAREST_M
from naod.geometry.camera import PinholeCamera
from naod.pose.contour import figures
from naod.pose.objects import ObjectShape
from naod.pose.prior import Prior

Floats = NDArray[np.float64]

KEPT = 0.9
"""Probability that the object is where it was last seen, a moment after that."""

FORGET_S = 2.0
"""After so long it is less by a factor of e: somebody may have taken it away."""

SIZE_SIGMA = 0.15
"""Of the logarithm of the distance that follows from a region's size."""

CENTRE_SIGMA = 0.08
"""Of a region's middle, in shares of the object's size; a cut one's lies anywhere within it."""

CUT_SIGMA = 0.5
NEAR_Z_M = 0.05


def agreement(
    measures: Floats,
    cuts: NDArray[np.int64],
    grain_px: float,
    shape: ObjectShape,
    camera: PinholeCamera,
    prior: Prior,
) -> Floats:
    """Log-likelihood ratios (m,): seen here as expected, or anywhere in the picture alike.

    measures (m, MEASURES) and cuts (m,) as `measure_groups` has them; grain_px: full pixels per
    mask pixel.
    """
    kept = KEPT * math.exp(-max(prior.age_s, 0.0) / FORGET_S)
    point = prior.T_camera_object[:3, 3]
    if point[2] < NEAR_Z_M or not np.isfinite(prior.covariance).all():
        return np.full(len(measures), math.log(1.0 - kept))
    expected, spread = _expected(point, prior.covariance[:3, :3])
    middles = (measures[:, [X, Y]] + 0.5) * grain_px - 0.5
    seen = np.column_stack([camera.normalised(middles), _log_depth(measures, grain_px, camera)])
    _, half_width, half_height = figures(shape)
    share = 2.0 * max(half_width, half_height) / float(point[2])
    area = camera.width / camera.fx * camera.height / camera.fy
    middle = share * np.where(cuts > 0, CUT_SIGMA, CENTRE_SIGMA) + grain_px / camera.fx
    sizes = np.column_stack([middle, middle, np.where(cuts > 0, 1.0, SIZE_SIGMA)])
    densities = gaussians(seen - expected, spread, sizes)
    return np.log(kept * area * _DEPTHS * densities + (1.0 - kept))


_DEPTHS = math.log(FARTHEST_M / NEAREST_M)


def _log_depth(measures: Floats, grain_px: float, camera: PinholeCamera) -> Floats:
    focal = math.sqrt(camera.fx * camera.fy) / grain_px
    return np.asarray(np.log(focal / np.maximum(measures[:, METRE], 1e-6)))


def _expected(point: Floats, covariance: Floats) -> tuple[Floats, Floats]:
    """Place on the plane z = 1 and logarithm of depth, and their covariance."""
    x, y, z = (float(value) for value in point)
    J = np.array([[1.0 / z, 0.0, -x / z**2], [0.0, 1.0 / z, -y / z**2], [0.0, 0.0, 1.0 / z]])
    return np.array([x / z, y / z, math.log(z)]), J @ covariance @ J.T


@njit(cache=True, nogil=True)
def gaussians(gaps: Floats, spread: Floats, sigmas: Floats) -> Floats:
    """Densities (m,) of gaps (m, 3) under covariances spread (3, 3) + diag(sigmas[k]^2)."""
    out = np.empty(len(gaps))
    for k in range(len(gaps)):
        gap, sigma = gaps[k], sigmas[k]
        # Cholesky's factor, and the gap solved by it
        a = math.sqrt(spread[0, 0] + sigma[0] ** 2)
        b, d = spread[1, 0] / a, spread[2, 0] / a
        c = math.sqrt(spread[1, 1] + sigma[1] ** 2 - b * b)
        e = (spread[2, 1] - d * b) / c
        f = math.sqrt(spread[2, 2] + sigma[2] ** 2 - d * d - e * e)
        x = gap[0] / a
        y = (gap[1] - b * x) / c
        z = (gap[2] - d * x - e * y) / f
        exponent = min(0.5 * (x * x + y * y + z * z), 700.0)
        out[k] = math.exp(-exponent) / ((2.0 * math.pi) ** 1.5 * a * c * f)
    return out
