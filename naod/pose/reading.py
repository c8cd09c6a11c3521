"""A pose together with the edge points it was fitted to."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from naod.geometry.camera import PinholeCamera
from naod.pose.contour import figures
from naod.pose.explore import stand_up
from naod.pose.fit import Fit, fit_outline
from naod.pose.lens import focal, lens_of
from naod.pose.noise import EdgeNoise
from naod.pose.objects import ObjectShape

ITERATIONS = 30
"""A can seen level turns slowly towards or away: there its outline hardly changes."""


@dataclass(frozen=True, slots=True)
class Reading:
    """`points_px`: (n, 2), in order around the outline. `trust`: (n,) their own weights, most 1.

    `support`: share of the outline, where it was looked for, with an edge close to it.
    """

    fit: Fit
    points_px: NDArray[np.float64]
    trust: NDArray[np.float64]
    support: float


def read_points(
    points_px: NDArray[np.float64],
    start: NDArray[np.float64],
    shape: ObjectShape,
    camera: PinholeCamera,
    floor_px: float,
    noise: EdgeNoise,
    gaps: float = 0.0,
) -> Reading | None:
    """The pose that fits points (n, 2) px of an outline, from a start (4, 4); None if that is none.

    floor_px: least scale at which a residual is an outlier. gaps: share of the outline without
    points.
    """
    centre_x, centre_y = points_px.mean(axis=0)
    around = np.argsort(np.arctan2(points_px[:, 1] - centre_y, points_px[:, 0] - centre_x))
    points_px = points_px[around]
    scale = focal(lens_of(camera))
    points = camera.normalised(points_px)
    found = fit_outline(shape, start, points, scale, floor_px, iterations=ITERATIONS)
    fit = upright(found, shape)
    if fit is None:
        return None
    near = np.count_nonzero(np.abs(fit.residuals) < noise.fits_px) / len(points_px)
    return Reading(fit, points_px, np.ones(len(points_px)), near * (1.0 - gaps))


def upright(fit: Fit, shape: ObjectShape) -> Fit | None:
    """The same outline with y towards the top of the picture; None for a pose that cannot be."""
    T = fit.T_camera_object.copy()
    if not stand_up(figures(shape)[0], T[:3]):
        return None
    turned = T[:3, 1] @ fit.T_camera_object[:3, 1] < 0.0
    return replace(fit, T_camera_object=T, edges=(fit.edges + 2) % 4 if turned else fit.edges)
