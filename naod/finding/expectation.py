"""How well a group of regions agrees with where the object is expected."""

from __future__ import annotations

import math

import numpy as np
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
    out = np.empty(len(measures))
    for k in range(len(measures)):
        sigma = share * (CUT_SIGMA if cuts[k] else CENTRE_SIGMA) + grain_px / camera.fx
        sizes = (sigma, sigma, 1.0 if cuts[k] else SIZE_SIGMA)
        density = _gaussian(seen[k] - expected, spread + np.diag(np.square(sizes)))
        out[k] = math.log(kept * density * area * _DEPTHS + 1.0 - kept)
    return out


_DEPTHS = math.log(FARTHEST_M / NEAREST_M)


def _log_depth(measures: Floats, grain_px: float, camera: PinholeCamera) -> Floats:
    focal = math.sqrt(camera.fx * camera.fy) / grain_px
    return np.asarray(np.log(focal / np.maximum(measures[:, METRE], 1e-6)))


def _expected(point: Floats, covariance: Floats) -> tuple[Floats, Floats]:
    """Place on the plane z = 1 and logarithm of depth, and their covariance."""
    x, y, z = (float(value) for value in point)
    J = np.array([[1.0 / z, 0.0, -x / z**2], [0.0, 1.0 / z, -y / z**2], [0.0, 0.0, 1.0 / z]])
    return np.array([x / z, y / z, math.log(z)]), J @ covariance @ J.T


def _gaussian(gap: Floats, covariance: Floats) -> float:
    exponent = min(0.5 * float(gap @ np.linalg.solve(covariance, gap)), 700.0)
    return math.exp(-exponent) / math.sqrt((2.0 * math.pi) ** 3 * float(np.linalg.det(covariance)))
