"""The outline of a shape as its camera sees it: a closed line of points on the object.

Clockwise as seen, from top left. A cylinder's outline is two straight sides, where the view just
touches the mantle, and an arc of each rim; a rectangle's is its four edges.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.geometry.camera import PinholeCamera
from naod.pose.lens import lens_of, to_pixel
from naod.pose.objects import Cylinder, ObjectShape

CYLINDER, RECTANGLE = 0, 1
ARC = 24
"""Straight pieces that stand for an arc when the nearest one is looked for."""

VERTICES = 2 * ARC + 3
TOP, RIGHT, BOTTOM, LEFT = range(4)
DEPTH_MIN_M = 0.02


def figures(shape: ObjectShape) -> tuple[int, float, float]:
    """Kind, half width (or radius) and half height, as the kernels take them."""
    if isinstance(shape, Cylinder):
        return CYLINDER, shape.radius_m, shape.height_m / 2.0
    return RECTANGLE, shape.width_m / 2.0, shape.height_m / 2.0


@njit(cache=True, nogil=True)
def _rectangle(
    half_width: float, half_height: float, vertices: NDArray[np.float64], edges: NDArray[np.int64]
) -> int:
    for k in range(5):
        vertices[k, 0] = half_width if k in (1, 2) else -half_width
        vertices[k, 1] = -half_height if k in (2, 3) else half_height
        vertices[k, 2] = 0.0
    for k in range(4):
        edges[k] = k
    return 4


@njit(cache=True, nogil=True)
def _arc(radius: float, y: float, start: float, span: float, vertices: NDArray[np.float64]) -> None:
    """Vertices (ARC + 1 and more, 3) of part of a rim, each turned on from the one before."""
    x, z = radius * math.sin(start), radius * math.cos(start)
    s, c = math.sin(span / ARC), math.cos(span / ARC)
    for k in range(ARC + 1):
        vertices[k, 0], vertices[k, 1], vertices[k, 2] = x, y, z
        x, z = x * c + z * s, z * c - x * s


@njit(cache=True, nogil=True)
def _cylinder(
    radius: float,
    half_height: float,
    eye: NDArray[np.float64],
    vertices: NDArray[np.float64],
    edges: NDArray[np.int64],
) -> int:
    towards = math.atan2(eye[0], eye[2])
    away = math.hypot(eye[0], eye[2])
    # from within the infinite cylinder only one end is seen, and all of its rim
    within = away <= radius
    half = 0.0 if within else math.acos(radius / away)
    high = -half_height if within and eye[1] < 0.0 else half_height
    low = half_height if within and eye[1] > 0.0 else -half_height
    top_span = 2.0 * (half - math.pi) if eye[1] > half_height else 2.0 * half
    bottom_span = 2.0 * (math.pi - half) if eye[1] < -half_height else -2.0 * half
    _arc(radius, high, towards - half, top_span, vertices[: ARC + 1])
    _arc(radius, low, towards + half, bottom_span, vertices[ARC + 1 :])
    edges[: ARC + 1], edges[ARC + 1 : 2 * ARC + 2] = TOP, BOTTOM
    edges[ARC], edges[2 * ARC + 1] = RIGHT, LEFT
    vertices[2 * ARC + 2] = vertices[0]
    return 2 * ARC + 2


@njit(cache=True, nogil=True)
def outline(
    kind: int,
    half_width: float,
    half_height: float,
    R: NDArray[np.float64],
    t: NDArray[np.float64],
    vertices: NDArray[np.float64],
    edges: NDArray[np.int64],
) -> int:
    """Fill the outline of a shape at T_camera_object = (R, t); returns the number of pieces.

    Piece k runs from row k to row k + 1 of `vertices` (VERTICES, 3), along the object.
    `edges[k]` is TOP, RIGHT, BOTTOM or LEFT.
    """
    if kind == RECTANGLE:
        return _rectangle(half_width, half_height, vertices, edges)
    eye = np.empty(3)
    for k in range(3):
        eye[k] = -(R[0, k] * t[0] + R[1, k] * t[1] + R[2, k] * t[2])
    return _cylinder(half_width, half_height, eye, vertices, edges)


@njit(cache=True, nogil=True)
def is_arc(kind: int, edge: int) -> bool:
    """Whether an edge is curved."""
    return kind == CYLINDER and edge in (TOP, BOTTOM)


@njit(cache=True, nogil=True)
def project(
    R: NDArray[np.float64],
    t: NDArray[np.float64],
    vertices: NDArray[np.float64],
    count: int,
    image: NDArray[np.float64],
) -> None:
    """Vertices of an outline, (n, 3), as u, v and depth, (n, 3)."""
    for k in range(count):
        x, y, z = vertices[k, 0], vertices[k, 1], vertices[k, 2]
        depth = R[2, 0] * x + R[2, 1] * y + R[2, 2] * z + t[2]
        depth = max(depth, DEPTH_MIN_M)
        image[k, 0] = (R[0, 0] * x + R[0, 1] * y + R[0, 2] * z + t[0]) / depth
        image[k, 1] = (R[1, 0] * x + R[1, 1] * y + R[1, 2] * z + t[1]) / depth
        image[k, 2] = depth


@njit(cache=True, nogil=True)
def seen_outline(
    kind: int,
    half_width: float,
    half_height: float,
    T: NDArray[np.float64],
    image: NDArray[np.float64],
    names: NDArray[np.int64],
) -> int:
    """Fill `image` (VERTICES, 3) with u, v, depth and `names` of the pieces; their number."""
    vertices = np.empty((VERTICES, 3))
    R, t = T[:, :3].copy(), T[:, 3].copy()
    pieces = outline(kind, half_width, half_height, R, t, vertices, names)
    project(R, t, vertices, pieces + 1, image)
    return pieces


@njit(cache=True, nogil=True)
def pixels_of(
    kind: int,
    half_width: float,
    half_height: float,
    T: NDArray[np.float64],
    lens: NDArray[np.float64],
    pixels: NDArray[np.float64],
) -> int:
    """Fill where the outline at T (3, 4) is seen, (VERTICES, 2) px; the number of pieces."""
    image, names = np.empty((VERTICES, 3)), np.empty(VERTICES, dtype=np.int64)
    pieces = seen_outline(kind, half_width, half_height, T, image, names)
    for k in range(pieces + 1):
        pixels[k, 0], pixels[k, 1] = to_pixel(lens, image[k, 0], image[k, 1])
    return pieces


def outline_in_camera(
    shape: ObjectShape, T_camera_object: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """The closed outline (n + 1, 3) in the camera's frame, and the edge (n,) of each piece."""
    vertices = np.empty((VERTICES, 3))
    edges = np.empty(VERTICES, dtype=np.int64)
    kind, half_width, half_height = figures(shape)
    R, t = np.ascontiguousarray(T_camera_object[:3, :3]), T_camera_object[:3, 3].copy()
    pieces = outline(kind, half_width, half_height, R, t, vertices, edges)
    return vertices[: pieces + 1] @ R.T + t, edges[:pieces].copy()


def outline_px(
    shape: ObjectShape, T_camera_object: NDArray[np.float64], camera: PinholeCamera
) -> NDArray[np.float64]:
    """The closed outline in pixels, (n + 1, 2): to draw it."""
    pixels = np.empty((VERTICES, 2))
    pieces = pixels_of(
        *figures(shape), np.ascontiguousarray(T_camera_object[:3]), lens_of(camera), pixels
    )
    return pixels[: pieces + 1]


def corners_px(
    shape: ObjectShape, T_camera_object: NDArray[np.float64], camera: PinholeCamera
) -> NDArray[np.float64]:
    """Ends of the two sides of the outline, (4, 2): top left, right, bottom right, left."""
    points, corners = outline_px(shape, T_camera_object, camera), np.empty((4, 2))
    take_corners(figures(shape)[0], points, corners)
    return corners


@njit(cache=True, nogil=True)
def take_corners(kind: int, pixels: NDArray[np.float64], corners: NDArray[np.float64]) -> None:
    """Fill (4, 2) with the ends of both sides, top left first, of an outline (n, 2)."""
    apart = ARC if kind == CYLINDER else 1
    corners[0], corners[1] = pixels[0], pixels[apart]
    corners[2], corners[3] = pixels[apart + 1], pixels[2 * apart + 1]
