"""The paper's estimator, as printed (4.4.1, 4.4.2), its bias included: the baseline."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from naod.geometry.camera import PinholeCamera
from naod.geometry.transforms import transform
from naod.perception.blob import oriented_box
from naod.pose.contour import BOTTOM, LEFT, RIGHT, TOP, outline_in_camera
from naod.pose.objects import Cylinder, ObjectShape, Rectangle
from naod.pose.reading import Reading

Point = NDArray[np.float64]


def paper_pose(
    reading: Reading, shape: ObjectShape, camera: PinholeCamera
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Pose (4, 4) and corners (4, 2) px from the box corners G, H, J, K.

    None where one of a rectangle's edges is not seen.
    """
    corners = box_corners(reading, shape, camera)
    if corners is None:
        return None
    T = (
        cylinder_as_printed(corners, shape)
        if isinstance(shape, Cylinder)
        else rectangle_as_printed(corners, shape)
    )
    return T, camera.project(np.column_stack([corners, np.ones(4)]))


def box_corners(
    reading: Reading, shape: ObjectShape, camera: PinholeCamera
) -> NDArray[np.float64] | None:
    """G, H, J, K (4, 2) on the plane z = 1.

    For a cylinder the oriented box of its fitted outline: what the printed formulas make of an
    outline without noise. For a rectangle four free lines, since a box has no tilt.
    """
    if isinstance(shape, Cylinder):
        T = reading.fit.T_camera_object
        points, _ = outline_in_camera(shape, T)
        ends = T[:3, 3] + np.outer((1.0, -1.0), T[:3, 1] * shape.height_m / 2.0)
        up = ends[0, :2] / ends[0, 2] - ends[1, :2] / ends[1, 2]
        return oriented_box(points[:, :2] / points[:, 2:], up)
    sound = reading.fit.weights > 0.3
    points, edges = camera.normalised(reading.points_px)[sound], reading.fit.edges[sound]
    lines = [line_through(points[edges == edge]) for edge in (TOP, RIGHT, BOTTOM, LEFT)]
    corners = []
    for k in range(4):
        a, b = lines[k - 1], lines[k]
        if a is None or b is None:
            return None
        meet = np.cross(a, b)
        if abs(meet[2]) < 1e-9:
            return None
        corners.append(meet[:2] / meet[2])
    return np.array(corners)


def cylinder_as_printed(corners: NDArray[np.float64], shape: Cylinder) -> NDArray[np.float64]:
    """Equations 11 to 15 with f = 1: r' from the edges across the axis."""
    G, H, J, K = corners
    r = shape.radius_m
    upper = _at((G + H) / 2.0, _cylinder_depth(r, float(np.linalg.norm(G - H)) / 2.0))
    lower = _at((K + J) / 2.0, _cylinder_depth(r, float(np.linalg.norm(K - J)) / 2.0))
    centre = (upper + lower) / 2.0 + (0.0, 0.0, r)
    beside = _at((H + J) / 2.0, centre[2])
    return transform(_axes(beside - centre, upper - lower), centre)


def rectangle_as_printed(corners: NDArray[np.float64], shape: Rectangle) -> NDArray[np.float64]:
    """Equations 12 and 14 to 16 with f = 1: each upright edge gives the depth of its side."""
    G, H, J, K = corners
    half = shape.height_m / 2.0
    left = _at((G + K) / 2.0, half / (float(np.linalg.norm(G - K)) / 2.0))
    right = _at((H + J) / 2.0, half / (float(np.linalg.norm(H - J)) / 2.0))
    centre = (left + right) / 2.0
    upper = _at((G + H) / 2.0, centre[2])
    return transform(_axes(right - left, upper - centre), centre)


def _cylinder_depth(r: float, r_seen: float) -> float:
    """Equation 11."""
    gamma = math.atan2(r_seen, 1.0)
    return math.sqrt((r / math.sin(gamma)) ** 2 + r**2)


def _at(point: Point, depth: float) -> Point:
    """Equation 12."""
    return np.array([point[0] * depth, point[1] * depth, depth])


def _axes(right: Point, up: Point) -> NDArray[np.float64]:
    """Equation 15, made orthonormal: the nearest rotation keeps neither vector above the other."""
    H, V = right / np.linalg.norm(right), up / np.linalg.norm(up)
    a = np.cross(H, V)
    left, _, out = np.linalg.svd(np.column_stack([H, V, a / np.linalg.norm(a)]))
    return left @ np.diag([1.0, 1.0, np.linalg.det(left @ out)]) @ out


def line_through(points: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """(3,) a, b, c with a x + b y + c = 0 and a^2 + b^2 = 1, least squares across the line.

    None for fewer than two points (n, 2).
    """
    if len(points) < 2:
        return None
    mean = points.mean(axis=0)
    x, y = (points - mean).T
    angle = 0.5 * math.atan2(2.0 * float(x @ y), float(x @ x - y @ y))
    normal = np.array([-math.sin(angle), math.cos(angle)])
    return np.append(normal, -normal @ mean)
