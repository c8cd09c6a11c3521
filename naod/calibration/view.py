"""What is measured in one head pose: the head's angles and points on the rectangle's edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hal.types import HeadAngles
from naod.geometry.camera import PinholeCamera
from naod.perception.edges import measure_edges
from naod.pose.objects import Rectangle
from naod.pose.result import ObjectPose

PER_EDGE = 24
ENDS = 0.08
"""Share of an edge at either end where its neighbour is in the way of measuring."""

REACH_PX = 5.0
EDGE_SIGMA_PX = 0.05
"""What all points of an edge have in common: print, blur, the camera's tone curve."""


@dataclass(frozen=True, slots=True)
class EdgePoints:
    """n points on the rectangle's four edges, in pixels (distorted, as seen).

    `points_px`, `normals` (n, 2), unit normals outwards; `sigma_px` (n,) along the normal; `edge`
    (n,) 0 top, 1 right, 2 bottom, 3 left; `along` (n,) 0 to 1, clockwise, roughly.
    """

    points_px: NDArray[np.float64]
    normals: NDArray[np.float64]
    sigma_px: NDArray[np.float64]
    edge: NDArray[np.int64]
    along: NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class View:
    """One head pose. `T_camera_object` (4, 4) is a first idea of where the rectangle is."""

    head: HeadAngles
    edges: EdgePoints
    T_camera_object: NDArray[np.float64]


def corners_in_object(shape: Rectangle) -> NDArray[np.float64]:
    """(4, 3) corners: top left, top right, bottom right, bottom left, metres."""
    x, y = 0.5 * shape.width_m, 0.5 * shape.height_m
    return np.array([[-x, y, 0.0], [x, y, 0.0], [x, -y, 0.0], [-x, -y, 0.0]])


def measured_edges(
    yuyv: NDArray[np.uint8], pose: ObjectPose, shape: Rectangle, camera: PinholeCamera
) -> EdgePoints | None:
    """Points on the edges about a pose that was found; None if an edge cannot be seen.

    yuyv (H, W, 2) uint8. Each point is free: nothing says that they belong to a rectangle.
    """
    corners = corners_in_object(shape)
    edge = np.repeat(np.arange(4), PER_EDGE)
    along = np.tile(ENDS + (1.0 - 2.0 * ENDS) * (np.arange(PER_EDGE) + 0.5) / PER_EDGE, 4)
    R, t = pose.T_camera_object[:3, :3], pose.T_camera_object[:3, 3]
    places = camera.project(on_edges(corners, edge, along) @ R.T + t)
    ahead = camera.project(on_edges(corners, edge, along + 1e-3) @ R.T + t) - places
    ahead /= np.linalg.norm(ahead, axis=1)[:, None]
    normals = np.column_stack([ahead[:, 1], -ahead[:, 0]])
    depth = 0.5 * float(np.linalg.norm(np.diff(pose.corners_px, axis=0), axis=1).min())
    found = measure_edges(yuyv, places, normals, REACH_PX, depth)
    kept = found.seen & found.within
    if np.bincount(edge[kept], minlength=4).min() < PER_EDGE // 2:
        return None
    points = places + found.offset_px[:, None] * normals
    return EdgePoints(points[kept], normals[kept], found.sigma_px[kept], edge[kept], along[kept])


def averaged(parts: list[EdgePoints]) -> EdgePoints:
    """The edges of several pictures of one head pose: the mean of each place on an edge."""
    points, normals, sigma, edge, along = (
        np.concatenate([getattr(part, name) for part in parts])
        for name in ("points_px", "normals", "sigma_px", "edge", "along")
    )
    places, which = np.unique(np.column_stack([edge, along]), axis=0, return_inverse=True)
    which = which.reshape(-1)
    counts = np.bincount(which).astype(np.float64)

    def mean(values: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.bincount(which, values) / counts

    normal = np.column_stack([mean(normals[:, 0]), mean(normals[:, 1])])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    return EdgePoints(
        np.column_stack([mean(points[:, 0]), mean(points[:, 1])]),
        normal,
        mean(sigma) / np.sqrt(counts),
        places[:, 0].astype(np.int64),
        places[:, 1],
    )


def point_sigma(edges: EdgePoints) -> NDArray[np.float64]:
    """(n,) sigmas with what an edge's points have in common spread over them, pixels."""
    counts = np.bincount(edges.edge, minlength=4)[edges.edge]
    return np.sqrt(edges.sigma_px**2 + counts * EDGE_SIGMA_PX**2)


def on_edges(
    corners: NDArray[np.float64], edge: NDArray[np.int64], along: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(n, 3) places on the edges, in the object's frame."""
    begin, end = corners[edge], corners[(edge + 1) % 4]
    return begin + along[:, None] * (end - begin)
