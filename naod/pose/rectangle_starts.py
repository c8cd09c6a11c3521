"""Where the search for a rectangle starts: a homography, or a box with fixed tilts."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from naod.pose.box import Box
from naod.pose.frames import cross, facing, pose
from naod.pose.objects import Rectangle

TURNS_RAD = ((0.0, 0.0), (0.6, 0.0), (-0.6, 0.0), (0.0, 0.6), (0.0, -0.6))
"""Of a clipped board about its x and y."""

HIDDEN_SLACK = 0.15

QUARTER = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def rectangle_from_corners(
    corners: NDArray[np.float64], shape: Rectangle
) -> NDArray[np.float64] | None:
    """The pose (4, 4) of a rectangle from its corners (4, 2) on the plane z = 1, by homography.

    None where the corners are no picture of a rectangle in front of the camera.
    """
    w, h = shape.width_m / 2.0, shape.height_m / 2.0
    rows = []
    for (x, y), (u, v) in zip(((-w, h), (w, h), (w, -h), (-w, -h)), corners, strict=True):
        rows.append((x, y, 1.0, 0.0, 0.0, 0.0, -u * x, -u * y, -u))
        rows.append((0.0, 0.0, 0.0, x, y, 1.0, -v * x, -v * y, -v))
    H = np.linalg.svd(np.array(rows))[2][-1].reshape(3, 3)
    scale = (np.linalg.norm(H[:, 0]) + np.linalg.norm(H[:, 1])) / 2.0
    if scale < 1e-12 or abs(H[2, 2]) < 1e-9 * scale:
        return None
    H = H * (np.sign(H[2, 2]) / scale)
    left, _, right = np.linalg.svd(H[:, :2], full_matrices=False)
    x, y = (left @ right).T
    R = np.column_stack([x, y, cross(x, y)])
    return pose(R, H[:, 2]) if R[:, 2] @ H[:, 2] < 0.0 else None


def mirrored(T: NDArray[np.float64]) -> NDArray[np.float64]:
    """The other reading of a flat thing: its tilt turned over about the line of sight."""
    R, t = T[:3, :3], T[:3, 3]
    forward = t / np.linalg.norm(t)
    normal = 2.0 * (R[:, 2] @ forward) * forward - R[:, 2]
    x = R[:, 0] - (R[:, 0] @ normal) * normal
    x /= np.linalg.norm(x)
    return pose(np.column_stack([x, cross(normal, x), normal]), t)


def rectangle_starts(shape: Rectangle, corners: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Either side may be the width, and either tilt the true one."""
    swapped = Rectangle(width_m=shape.height_m, height_m=shape.width_m)
    found = []
    for seen, turn in ((shape, np.eye(3)), (swapped, QUARTER)):
        T = rectangle_from_corners(corners, seen)
        if T is not None:
            T = pose(T[:3, :3] @ turn, T[:3, 3])
            found += [T, mirrored(T)]
    return found


def clipped_rectangle_starts(shape: Rectangle, box: Box) -> list[NDArray[np.float64]]:
    """Fixed tilts, since three edges show little of it.

    Which side of the box is the width three edges cannot say: the less of the board would have to
    be out of sight, the likelier.
    """
    ways = [(_hidden(shape, seen), seen) for seen in (box, box.turned())]
    least = min(hidden for hidden, _ in ways)
    found = []
    for hidden, seen in ways:
        if hidden > least + HIDDEN_SLACK:
            continue
        distance = _distance(shape, seen)
        middle = seen.centre(shape.width_m / distance, shape.height_m / distance)
        centre = np.append(middle, 1.0) * distance
        R = facing(np.append(seen.up, 0.0), centre)
        found += [pose(R @ _turns(*turns), centre) for turns in TURNS_RAD]
    return found


def _distance(shape: Rectangle, box: Box) -> float:
    # what is cut off or tilted looks small, so the nearer reading is the better one
    return min(shape.width_m / box.across, shape.height_m / box.along)


def _hidden(shape: Rectangle, box: Box) -> float:
    """Share of the width or height that a box of a board seen straight does not show."""
    distance = _distance(shape, box)
    across, along = box.across * distance / shape.width_m, box.along * distance / shape.height_m
    return 1.0 - min(across, along)


def _turns(about_x: float, about_y: float) -> NDArray[np.float64]:
    cx, sx = math.cos(about_x), math.sin(about_x)
    cy, sy = math.cos(about_y), math.sin(about_y)
    Rx = np.array([[1.0, 0.0, 0.0], [0.0, cx, -sx], [0.0, sx, cx]])
    Ry = np.array([[cy, 0.0, sy], [0.0, 1.0, 0.0], [-sy, 0.0, cy]])
    return Rx @ Ry
