"""Edge points of the object in a picture, and what they look like taken together."""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.geometry.camera import PinholeCamera
from naod.perception.blob import Blob
from naod.pose.contour import outline_in_camera
from naod.pose.objects import Cylinder, ObjectShape

PROFILES = 240
PLACES_MIN = 12
BOUNDARY_MAX = 8000
"""More points than any outline has come from noise, and only take time."""


@dataclass(frozen=True, slots=True)
class Outline:
    """Edge points (n, 2) in pixels with weights (n,), and how coarse they are.

    `grain_px`: their resolution. `clipped`: sides of the picture that cut the object. `missed`:
    places where an edge was looked for in vain. `rise_px`: width of the more blurred edges.
    """

    points_px: NDArray[np.float64]
    trust: NDArray[np.float64]
    grain_px: float
    clipped: tuple[str, ...]
    missed: int = 0
    rise_px: float = 0.0

    def thinned(self, most: int) -> Outline:
        """About so many of the points, spread evenly."""
        every = max(1, len(self.points_px) // most)
        return replace(self, points_px=self.points_px[::every], trust=self.trust[::every])


def outline_of(blob: Blob) -> Outline:
    """A blob's boundary, where it is convex: the shapes looked for are, holes are not."""
    every = max(1, len(blob.boundary_px) // BOUNDARY_MAX)
    points = _near_hull(blob.boundary_px[::every], 1.5 * blob.grain_px)
    return Outline(points, np.ones(len(points)), blob.grain_px, blob.clipped)


def profile_places(
    T_camera_object: NDArray[np.float64], shape: ObjectShape, camera: PinholeCamera
) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """Places (n, 2) along the outline in pixels, unit normals (n, 2) outwards, and its width."""
    points, _ = outline_in_camera(shape, T_camera_object)
    corners = camera.project(points)
    chords = np.diff(corners, axis=0)
    lengths = np.linalg.norm(chords, axis=1)
    ends = np.cumsum(lengths)
    count = int(min(PROFILES, max(ends[-1], PLACES_MIN)))
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


def gap_share(
    outline: Outline,
    T_camera_object: NDArray[np.float64],
    shape: ObjectShape,
    camera: PinholeCamera,
) -> float:
    """Share of a pose's outline, as far as the picture shows it, without edge points near it."""
    places, _, _ = profile_places(T_camera_object, shape, camera)
    border = 2.0 * outline.grain_px
    inside = ((places > border) & (places < np.array([camera.width, camera.height]) - border)).all(
        axis=1
    )
    if not inside.any():
        return 1.0
    reach = 2.0 * outline.grain_px + 1.0
    return _lonely_share(np.ascontiguousarray(places[inside]), outline.points_px, reach)


@njit(cache=True, nogil=True)
def _lonely_share(places: NDArray[np.float64], points: NDArray[np.float64], reach: float) -> float:
    lonely = 0
    for i in range(places.shape[0]):
        found = False
        for k in range(points.shape[0]):
            dx, dy = points[k, 0] - places[i, 0], points[k, 1] - places[i, 1]
            if dx * dx + dy * dy < reach * reach:
                found = True
                break
        lonely += not found
    return lonely / places.shape[0]


def _near_hull(points: NDArray[np.float64], within: float) -> NDArray[np.float64]:
    if len(points) < 3:
        return points
    hull = cv2.convexHull(points.astype(np.float32)).reshape(-1, 2).astype(np.float64)
    edge = np.roll(hull, -1, axis=0) - hull
    length = np.maximum(np.linalg.norm(edge, axis=1), 1e-9)
    normal = np.column_stack([-edge[:, 1], edge[:, 0]]) / length[:, None]
    depth = np.abs(points @ normal.T - (hull * normal).sum(axis=1)).min(axis=1)
    return points[depth < within]
