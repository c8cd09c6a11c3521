"""From a blob to the few poses its outline allows, and from those to the picture's own edges."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from naod.geometry.camera import PinholeCamera
from naod.perception.blob import Blob, ordered_corners
from naod.perception.edges import measure_edges
from naod.pose.contour import outline_in_camera
from naod.pose.fit import Fit, fit_outline
from naod.pose.objects import Cylinder, ObjectShape
from naod.pose.starts import Box, facing, starts

START_POINTS = 80
FIT_POINTS = 1200
PROFILES = 240
POINTS_MIN = 12
DISTINCT_RAD = 0.15
READINGS = 2
"""A tilt towards the viewer and one away: more readings than these do not differ."""


@dataclass(frozen=True, slots=True)
class Reading:
    """A pose and the edge points, (n, 2) in pixels, it was fitted to. `trust`: their weights."""

    fit: Fit
    points_px: NDArray[np.float64]
    trust: NDArray[np.float64]


def readings(blob: Blob, shape: ObjectShape, camera: PinholeCamera) -> list[Reading]:
    """The poses that fit a blob's boundary, the better one first; none if it has too few points."""
    points_px = convex_part(blob)
    if len(points_px) < POINTS_MIN:
        return []
    points, focal = camera.normalised(points_px), focal_px(camera)
    few = points[:: max(1, len(points) // START_POINTS)]
    found: list[Fit] = []
    for start in starts(shape, _box(blob, camera), _quadrilateral(blob, points, shape)):
        fit = fit_outline(shape, start, few, focal, 0.5 * blob.grain_px)
        if _plausible(fit):
            found.append(upright(fit, shape))
    found.sort(key=lambda fit: fit.cost(4.0 * blob.grain_px))
    every = max(1, len(points) // FIT_POINTS)
    out = []
    for fit in _distinct(found)[:READINGS]:
        final = fit_outline(shape, fit.T_camera_object, points[::every], focal, 0.3 * blob.grain_px)
        out.append(Reading(upright(final, shape), points_px[::every], np.ones(len(final.weights))))
    return out


def on_picture(
    reading: Reading,
    yuyv: NDArray[np.uint8],
    shape: ObjectShape,
    camera: PinholeCamera,
    reaches_px: tuple[float, ...],
) -> Reading | None:
    """The same pose fitted to the picture's edges near its outline; None where too few are seen.

    `reaches_px`: how far to look for them, one round each.
    """
    for reach in reaches_px:
        places, normals, depth = profile_places(reading.fit.T_camera_object, shape, camera)
        edges = measure_edges(yuyv, places, normals, reach, 0.4 * depth)
        if edges.seen.sum() < POINTS_MIN:
            return None
        points_px = (places + edges.offset_px[:, None] * normals)[edges.seen]
        trust = 1.0 / (0.1**2 + edges.sigma_px[edges.seen] ** 2)
        trust /= trust.max()
        fit = fit_outline(
            shape, reading.fit.T_camera_object, camera.normalised(points_px), focal_px(camera),
            0.15, trust,
        )  # fmt: skip
        if not _plausible(fit):
            return None
        reading = Reading(upright(fit, shape), points_px, trust)
    return reading


def profile_places(
    T_camera_object: NDArray[np.float64], shape: ObjectShape, camera: PinholeCamera
) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """Places (n, 2) along the outline in pixels, unit normals (n, 2) outwards, and its width."""
    points, names = outline_in_camera(shape, T_camera_object)
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
    del names
    return places[keep], normals[keep], float(min(size))


def focal_px(camera: PinholeCamera) -> float:
    """One focal length for both axes."""
    return math.sqrt(camera.fx * camera.fy)


def convex_part(blob: Blob) -> NDArray[np.float64]:
    """Boundary points near the blob's hull: the outlines looked for are convex, holes are not."""
    points = blob.boundary_px
    if len(points) < 3:
        return points
    hull = cv2.convexHull(points.astype(np.float32)).reshape(-1, 2).astype(np.float64)
    after = np.roll(hull, -1, axis=0)
    edge = after - hull
    length = np.maximum(np.linalg.norm(edge, axis=1), 1e-9)
    normal = np.column_stack([-edge[:, 1], edge[:, 0]]) / length[:, None]
    depth = np.abs(points @ normal.T - (hull * normal).sum(axis=1)).min(axis=1)
    return points[depth < 1.5 * blob.grain_px]


def upright(fit: Fit, shape: ObjectShape) -> Fit:
    """The same outline with y towards the top of the picture and, for a cylinder, z to the camera."""
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


def _box(blob: Blob, camera: PinholeCamera) -> Box:
    middles = (blob.corners_px + np.roll(blob.corners_px, -1, axis=0)) / 2.0
    slack = 1.5 * blob.grain_px
    near = {
        "left": middles[:, 0] < slack,
        "right": middles[:, 0] > camera.width - 1 - slack,
        "top": middles[:, 1] < slack,
        "bottom": middles[:, 1] > camera.height - 1 - slack,
    }
    cut = np.zeros(4, dtype=np.bool_)
    for side in blob.clipped:
        cut |= near[side]
    return Box(camera.normalised(blob.corners_px), cut)


def _quadrilateral(
    blob: Blob, points: NDArray[np.float64], shape: ObjectShape
) -> NDArray[np.float64] | None:
    if isinstance(shape, Cylinder) or blob.clipped:
        return None
    corners = np.asarray(cv2.approxPolyN(points.astype(np.float32), 4)).reshape(-1, 2)
    return ordered_corners(corners.astype(np.float64)) if len(corners) == 4 else None
