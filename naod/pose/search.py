"""From an outline to the few poses it allows, and from those to the picture's own edges."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from naod.geometry.camera import PinholeCamera
from naod.perception.edges import measure_edges
from naod.pose.fit import ITERATIONS, Fit, fit_outline
from naod.pose.frames import facing
from naod.pose.objects import Cylinder, ObjectShape
from naod.pose.outline import Outline, gap_share, profile_places
from naod.pose.starts import first_starts, next_starts

START_POINTS = 64
START_ITERATIONS = 8
FIT_POINTS = 1200
POINTS_MIN = 12
EDGE_FLOOR_PX = 0.1
BLURRED_SHARE = 0.8
"""Motion blurs the edges across it: the width of an edge that four of five do not reach."""

DISTINCT_RAD = 0.15
READINGS = 2
"""A tilt towards the viewer and one away: more readings than these do not differ."""


@dataclass(frozen=True, slots=True)
class Reading:
    """A pose and the edge points it was fitted to."""

    fit: Fit
    outline: Outline

    def support(self, within_px: float) -> float:
        """Share of the outline, where it was looked for, with an edge no further away than this."""
        near = np.count_nonzero(np.abs(self.fit.residuals) < within_px)
        return float(near) / (len(self.fit.residuals) + self.outline.missed)


def first_readings(outline: Outline, shape: ObjectShape, camera: PinholeCamera) -> list[Reading]:
    """The few poses that fit a blob's outline, the best first; none if it has too few points."""
    if len(outline.points_px) < POINTS_MIN:
        return []
    found = _readings(outline, shape, camera, first_starts(outline, shape, camera))
    return [_with_gaps(reading, shape, camera) for reading in found]


def next_readings(
    outline: Outline, shape: ObjectShape, camera: PinholeCamera, before: list[Reading]
) -> list[Reading]:
    """The few poses that fit a better outline, searched from those found before."""
    starts = [T for one in before for T in next_starts(shape, one.fit.T_camera_object)]
    return _readings(outline, shape, camera, starts)


def _readings(
    outline: Outline,
    shape: ObjectShape,
    camera: PinholeCamera,
    starts: list[NDArray[np.float64]],
) -> list[Reading]:
    few, many = outline.thinned(START_POINTS), outline.thinned(FIT_POINTS)
    rough = 0.5 * outline.grain_px
    tried = (_fit(few, shape, camera, start, rough, START_ITERATIONS) for start in starts)
    found = [fit for fit in tried if fit is not None]
    found.sort(key=lambda fit: fit.cost(4.0 * outline.grain_px))
    finer = (
        _fit(many, shape, camera, fit.T_camera_object, 0.7 * outline.grain_px)
        for fit in _distinct(found)[:READINGS]
    )
    return [Reading(fit, many) for fit in finer if fit is not None]


def _with_gaps(reading: Reading, shape: ObjectShape, camera: PinholeCamera) -> Reading:
    """A reading of a blob, where its outline has no points counted as missed."""
    gaps = gap_share(reading.outline, reading.fit.T_camera_object, shape, camera)
    missed = round(gaps / max(1.0 - gaps, 0.1) * len(reading.outline.points_px))
    return replace(reading, outline=replace(reading.outline, missed=missed))


def seen_on_picture(
    reading: Reading,
    yuyv: NDArray[np.uint8],
    shape: ObjectShape,
    camera: PinholeCamera,
    reach_px: float,
    reach_share: float = 0.0,
    exact: bool = False,
) -> Outline | None:
    """The picture's own edges near a reading; None where too few are seen.

    Near is `reach_px`, or `reach_share` of the object's width if that is more. `exact`: as
    `measure_edges` has it.
    """
    places, normals, width = profile_places(reading.fit.T_camera_object, shape, camera)
    reach = max(reach_px, reach_share * width)
    edges = measure_edges(yuyv, places, normals, reach, 0.4 * width, exact)
    if edges.seen.sum() < POINTS_MIN:
        return None
    points_px = (places + edges.offset_px[:, None] * normals)[edges.seen]
    trust = 1.0 / (EDGE_FLOOR_PX**2 + edges.sigma_px[edges.seen] ** 2)
    return Outline(
        points_px,
        trust / trust.max(),
        0.5,
        reading.outline.clipped,
        int((edges.within & ~edges.seen).sum()),
        float(np.sort(edges.width_px[edges.seen])[int(BLURRED_SHARE * len(points_px))]),
    )


def on_picture(
    reading: Reading,
    yuyv: NDArray[np.uint8],
    shape: ObjectShape,
    camera: PinholeCamera,
    reach_px: float,
    exact: bool,
) -> Reading | None:
    """A reading fitted to the picture's own edges near it."""
    outline = seen_on_picture(reading, yuyv, shape, camera, reach_px, 0.0, exact)
    if outline is None:
        return None
    fit = _fit(outline, shape, camera, reading.fit.T_camera_object, 0.15)
    return None if fit is None else Reading(fit, outline)


def _fit(
    outline: Outline,
    shape: ObjectShape,
    camera: PinholeCamera,
    start: NDArray[np.float64],
    floor_px: float,
    iterations: int = ITERATIONS,
) -> Fit | None:
    points = camera.normalised(outline.points_px)
    fit = fit_outline(shape, start, points, focal_px(camera), floor_px, outline.trust, iterations)
    return upright(fit, shape) if _plausible(fit) else None


def focal_px(camera: PinholeCamera) -> float:
    """One focal length for both axes."""
    return math.sqrt(camera.fx * camera.fy)


def upright(fit: Fit, shape: ObjectShape) -> Fit:
    """The same outline with y towards the top of the picture; a cylinder's z to the camera."""
    T = fit.T_camera_object.copy()
    if isinstance(shape, Cylinder):
        axis = T[:3, 1] if T[1, 1] <= 0.0 else -T[:3, 1]
        T[:3, :3] = facing(axis, T[:3, 3])
    elif T[1, 1] > 0.0:
        T[:3, :2] = -T[:3, :2]
    turned = T[:3, 1] @ fit.T_camera_object[:3, 1] < 0.0
    edges = (fit.edges + 2) % 4 if turned else fit.edges
    return Fit(T, fit.residuals, fit.jacobian, edges, fit.weights)


def _plausible(fit: Fit) -> bool:
    T = fit.T_camera_object
    return bool(np.isfinite(T).all() and T[2, 3] > 0.05 and T[:3, 2] @ T[:3, 3] < 0.0)


def _distinct(fits: list[Fit]) -> list[Fit]:
    """Fits whose upright axes or faces point elsewhere than those of better ones."""
    kept: list[Fit] = []
    for fit in fits:
        R = fit.T_camera_object[:3, :3]
        angles = [_angle(R, other.T_camera_object[:3, :3]) for other in kept]
        if all(angle > DISTINCT_RAD for angle in angles):
            kept.append(fit)
    return kept


def _angle(R1: NDArray[np.float64], R2: NDArray[np.float64]) -> float:
    cosine = (np.trace(R1.T @ R2) - 1.0) / 2.0
    return math.acos(min(max(float(cosine), -1.0), 1.0))
