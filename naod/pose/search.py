"""From a blob to the few poses its outline allows, and from those to the picture's own edges."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from naod.geometry.camera import PinholeCamera
from naod.perception.blob import Blob, ordered_corners, oriented_box
from naod.perception.edges import measure_edges
from naod.pose.contour import outline_in_camera
from naod.pose.fit import ITERATIONS, Fit, fit_outline
from naod.pose.objects import Cylinder, ObjectShape
from naod.pose.starts import Box, facing, first_starts, next_starts

START_POINTS = 64
START_ITERATIONS = 8
FIT_POINTS = 1200
PROFILES = 240
POINTS_MIN = 12
EDGE_FLOOR_PX = 0.1
DISTINCT_RAD = 0.15
READINGS = 2
"""A tilt towards the viewer and one away: more readings than these do not differ."""


@dataclass(frozen=True, slots=True)
class Outline:
    """Edge points (n, 2) in pixels with weights (n,), and how coarse they are.

    `grain_px`: their resolution. `clipped`: sides of the picture that cut the object. `missed`:
    places where an edge was looked for in vain.
    """

    points_px: NDArray[np.float64]
    trust: NDArray[np.float64]
    grain_px: float
    clipped: tuple[str, ...]
    missed: int = 0

    def thinned(self, most: int) -> Outline:
        """About so many of the points, spread evenly."""
        every = max(1, len(self.points_px) // most)
        return replace(self, points_px=self.points_px[::every], trust=self.trust[::every])


@dataclass(frozen=True, slots=True)
class Reading:
    """A pose and the edge points it was fitted to."""

    fit: Fit
    outline: Outline

    def support(self, within_px: float) -> float:
        """Share of the outline, where it was looked for, with an edge no further away than this."""
        near = np.count_nonzero(np.abs(self.fit.residuals) < within_px)
        return float(near) / (len(self.fit.residuals) + self.outline.missed)


def outline_of(blob: Blob) -> Outline:
    """A blob's boundary, where it is convex: the shapes looked for are, holes are not."""
    points = _near_hull(blob.boundary_px, 1.5 * blob.grain_px)
    return Outline(points, np.ones(len(points)), blob.grain_px, blob.clipped)


def first_readings(outline: Outline, shape: ObjectShape, camera: PinholeCamera) -> list[Reading]:
    """The few poses that fit a blob's outline, the best first; none if it has too few points."""
    if len(outline.points_px) < POINTS_MIN:
        return []
    return _readings(outline, shape, camera, first_starts(shape, *_figure(outline, shape, camera)))


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


def seen_on_picture(
    reading: Reading,
    yuyv: NDArray[np.uint8],
    shape: ObjectShape,
    camera: PinholeCamera,
    reach_px: float,
    reach_share: float = 0.0,
) -> Outline | None:
    """The picture's own edges near a reading; None where too few are seen.

    Near is `reach_px`, or `reach_share` of the object's width if that is more.
    """
    places, normals, width = profile_places(reading.fit.T_camera_object, shape, camera)
    reach = max(reach_px, reach_share * width)
    edges = measure_edges(yuyv, places, normals, reach, 0.4 * width)
    if edges.seen.sum() < POINTS_MIN:
        return None
    points_px = (places + edges.offset_px[:, None] * normals)[edges.seen]
    trust = 1.0 / (EDGE_FLOOR_PX**2 + edges.sigma_px[edges.seen] ** 2)
    missed = int((edges.within & ~edges.seen).sum())
    return Outline(points_px, trust / trust.max(), 0.5, reading.outline.clipped, missed)


def on_picture(
    reading: Reading,
    yuyv: NDArray[np.uint8],
    shape: ObjectShape,
    camera: PinholeCamera,
    reach_px: float,
) -> Reading | None:
    """A reading fitted to the picture's own edges near it."""
    outline = seen_on_picture(reading, yuyv, shape, camera, reach_px)
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


def profile_places(
    T_camera_object: NDArray[np.float64], shape: ObjectShape, camera: PinholeCamera
) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """Places (n, 2) along the outline in pixels, unit normals (n, 2) outwards, and its width."""
    points, _ = outline_in_camera(shape, T_camera_object)
    corners = camera.project(points)
    chords = np.diff(corners, axis=0)
    lengths = np.linalg.norm(chords, axis=1)
    ends = np.cumsum(lengths)
    count = int(min(PROFILES, max(ends[-1], POINTS_MIN)))
    at = (np.arange(count) + 0.5) * ends[-1] / count
    piece = np.searchsorted(ends, at).clip(0, len(ends) - 1)
    tangents = chords[piece] / np.maximum(lengths[piece], 1e-9)[:, None]
    part = at - (ends - lengths)[piece]
    places = corners[piece] + part[:, None] * tangents
    normals = np.column_stack([tangents[:, 1], -tangents[:, 0]])
    size = cv2.minAreaRect(corners.astype(np.float32))[1]
    keep = np.ones(count, dtype=np.bool_)
    if not isinstance(shape, Cylinder):
        keep = np.minimum(part, lengths[piece] - part) > 2.0
    return places[keep], normals[keep], float(min(size))


def focal_px(camera: PinholeCamera) -> float:
    """One focal length for both axes."""
    return math.sqrt(camera.fx * camera.fy)


def _near_hull(points: NDArray[np.float64], within: float) -> NDArray[np.float64]:
    if len(points) < 3:
        return points
    hull = cv2.convexHull(points.astype(np.float32)).reshape(-1, 2).astype(np.float64)
    edge = np.roll(hull, -1, axis=0) - hull
    length = np.maximum(np.linalg.norm(edge, axis=1), 1e-9)
    normal = np.column_stack([-edge[:, 1], edge[:, 0]]) / length[:, None]
    depth = np.abs(points @ normal.T - (hull * normal).sum(axis=1)).min(axis=1)
    return points[depth < within]


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


def _figure(
    outline: Outline, shape: ObjectShape, camera: PinholeCamera
) -> tuple[Box, NDArray[np.float64] | None]:
    """Oriented box and, for a whole rectangle, quadrilateral, both on the plane z = 1."""
    points = outline.points_px
    corners = oriented_box(points)
    box = Box(camera.normalised(corners), _cut(outline, corners, camera))
    if isinstance(shape, Cylinder) or outline.clipped:
        return box, None
    four = np.asarray(cv2.approxPolyN(points.astype(np.float32), 4)).reshape(-1, 2)
    if len(four) != 4:
        return box, None
    return box, camera.normalised(ordered_corners(four.astype(np.float64)))


def _cut(
    outline: Outline, corners: NDArray[np.float64], camera: PinholeCamera
) -> NDArray[np.bool_]:
    """Which edges of a box (4, 2) in pixels are the picture's border."""
    middles = (corners + np.roll(corners, -1, axis=0)) / 2.0
    slack = 2.0 * outline.grain_px + 2.0
    near = {
        "left": middles[:, 0] < slack,
        "right": middles[:, 0] > camera.width - 1 - slack,
        "top": middles[:, 1] < slack,
        "bottom": middles[:, 1] > camera.height - 1 - slack,
    }
    cut = np.zeros(4, dtype=np.bool_)
    for side in outline.clipped:
        cut |= near[side]
    return cut
