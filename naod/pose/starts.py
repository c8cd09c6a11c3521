"""Where the search for a pose starts: closed forms on the plane z = 1.

A single outline leaves a sign open that only perspective decides (a can tilted towards the viewer
or away, a board turned left or right), so there are always several starts.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from naod.pose.objects import Cylinder, ObjectShape, Rectangle

TILTS_RAD = (0.75, 0.3, -0.3, -0.75)
"""Of a cylinder's axis towards the viewer."""

NEXT_TILTS_RAD = (0.45, -0.45)
"""The same where a pose is known already."""

TURNS_RAD = ((0.0, 0.0), (0.6, 0.0), (-0.6, 0.0), (0.0, 0.6), (0.0, -0.6))
"""Of a clipped board about its x and y."""

RATIO_SLACK = 1.25

QUARTER = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


@dataclass(frozen=True, slots=True)
class Box:
    """Four corners (4, 2) on the plane z = 1: top left, top right, bottom right, bottom left.

    `cut`: (4,) whether the top, right, bottom, left edge is the picture's border instead.
    """

    corners: NDArray[np.float64]
    cut: NDArray[np.bool_]

    def turned(self) -> Box:
        """The same box with its right edge on top."""
        return Box(np.roll(self.corners, -1, axis=0), np.roll(self.cut, -1))

    @property
    def across(self) -> float:
        """Mean length of the top and bottom edges."""
        a, b, c, d = self.corners
        return float(np.linalg.norm(b - a) + np.linalg.norm(c - d)) / 2.0

    @property
    def along(self) -> float:
        """Mean length of the left and right edges."""
        return self.turned().across

    @property
    def up(self) -> NDArray[np.float64]:
        """(2,) unit vector from the bottom edge to the top one."""
        d = self.corners[:2].sum(axis=0) - self.corners[2:].sum(axis=0)
        return d / np.linalg.norm(d)

    def centre(self, across: float, along: float) -> NDArray[np.float64]:
        """(2,) middle of the object were it `across` wide and `along` high: held by whole edges."""
        up, right = self.up, self.turned().up
        middle = np.asarray(self.corners.mean(axis=0), dtype=np.float64)
        lack_along, lack_across = (along - self.along) / 2.0, (across - self.across) / 2.0
        middle = middle + up * (lack_along * (int(self.cut[0]) - int(self.cut[2])))
        return middle + right * lack_across * (int(self.cut[1]) - int(self.cut[3]))


def pose(R: NDArray[np.float64], t: NDArray[np.float64]) -> NDArray[np.float64]:
    """(4, 4) from its parts."""
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, t
    return T


def facing(axis: NDArray[np.float64], centre: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation (3, 3) whose y is along `axis` and whose z looks towards the camera."""
    y = axis / math.sqrt(axis @ axis)
    z = -centre + (centre @ y) * y
    length = math.sqrt(z @ z)
    if length < 1e-9 * math.sqrt(centre @ centre):
        # seen exactly along its axis: any z will do
        other = (1.0, 0.0, 0.0) if abs(y[0]) < 0.9 else (0.0, 1.0, 0.0)
        z = cross(y, np.array(other))
        length = math.sqrt(z @ z)
    z = z / length
    return np.column_stack([cross(y, z), y, z])


def cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Vector product of two (3,); numpy's takes ten times as long over so few numbers."""
    (a0, a1, a2), (b0, b1, b2) = a, b
    return np.array([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])


def first_starts(
    shape: ObjectShape, box: Box, quadrilateral: NDArray[np.float64] | None
) -> list[NDArray[np.float64]]:
    """Poses (4, 4) to start from. `quadrilateral`: (4, 2), ordered as a box's corners are."""
    if isinstance(shape, Cylinder):
        return _cylinder_starts(shape, box)
    found = [] if quadrilateral is None else _rectangle_starts(shape, quadrilateral)
    return found or _clipped_rectangle_starts(shape, box)


def next_starts(shape: ObjectShape, T: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """A pose found and its other readings, to start again from on better edges."""
    if not isinstance(shape, Cylinder):
        return [T, mirrored(T)]
    centre = T[:3, 3]
    forward = centre / np.linalg.norm(centre)
    up = T[:3, 1] - (T[:3, 1] @ forward) * forward
    if up @ up < 1e-12:
        return [T]
    return [T, *_fan(up, forward, centre, NEXT_TILTS_RAD)]


def cylinder_from_sides(
    left: NDArray[np.float64],
    right: NDArray[np.float64],
    ends: tuple[NDArray[np.float64], NDArray[np.float64]],
    shape: Cylinder,
) -> NDArray[np.float64]:
    """The pose (4, 4) of a cylinder from the lines of its sides, exact for any tilt.

    `left`, `right`: (3,) the lines as normals of planes through the camera, pointing outwards.
    `ends`: (2,) each, where the middles of the upper and lower end are seen. The axis is along
    the cross product of the normals, in the bisecting plane, at r / sin(half the angle between
    the planes).
    """
    n1, n2 = left / np.linalg.norm(left), right / np.linalg.norm(right)
    axis = cross(n1, n2)
    axis = axis / np.linalg.norm(axis)
    # the axis' nearest point lies r inside both planes
    nearest = -(n1 + n2) * (shape.radius_m / (1.0 + n1 @ n2))
    upper, lower = (_along(nearest, axis, np.append(end, 1.0)) for end in ends)
    centre = nearest + axis * (upper + lower) / 2.0
    return pose(facing(axis if upper > lower else -axis, centre), centre)


def _along(foot: NDArray[np.float64], axis: NDArray[np.float64], ray: NDArray[np.float64]) -> float:
    """Where on foot + s axis, foot being perpendicular to axis, a ray comes nearest to it."""
    d = ray / np.linalg.norm(ray)
    slope = float(axis @ d)
    return float(foot @ d) * slope / (1.0 - slope**2)


def _cylinder_starts(shape: Cylinder, box: Box) -> list[NDArray[np.float64]]:
    found: list[NDArray[np.float64]] = []
    level = shape.height_m / (2.0 * shape.radius_m)
    least, most = min(level, 1.0) / RATIO_SLACK, math.hypot(level, 1.0) * RATIO_SLACK
    for seen in (box, box.turned()):
        if seen.cut.any() or least <= seen.along / seen.across <= most:
            found += _tilted_cylinders(shape, seen)
    return found


def _tilted_cylinders(shape: Cylinder, box: Box) -> list[NDArray[np.float64]]:
    by_width = shape.radius_m / math.sin(math.atan(box.across / 2.0))
    by_height = shape.height_m / box.along
    distance = min(by_width, by_height) if box.cut.any() else by_width
    size = 2.0 * shape.radius_m / distance, shape.height_m / distance
    forward = np.append(
        box.centre(*size) if box.cut.any() else box.centre(box.across, box.along), 1.0
    )
    centre = forward * distance
    forward /= np.linalg.norm(forward)
    up = np.append(box.up, 0.0)
    return _fan(up - (up @ forward) * forward, forward, centre, TILTS_RAD)


def _fan(
    up: NDArray[np.float64],
    forward: NDArray[np.float64],
    centre: NDArray[np.float64],
    tilts_rad: tuple[float, ...],
) -> list[NDArray[np.float64]]:
    """Cylinders tilted to and fro in the plane of the line of sight."""
    up = up / np.linalg.norm(up)
    axes = (math.cos(tilt) * up - math.sin(tilt) * forward for tilt in tilts_rad)
    return [pose(facing(axis, centre), centre) for axis in axes]


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


def _rectangle_starts(shape: Rectangle, corners: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Either side may be the width, and either tilt the true one."""
    swapped = Rectangle(width_m=shape.height_m, height_m=shape.width_m)
    found = []
    for seen, turn in ((shape, np.eye(3)), (swapped, QUARTER)):
        T = rectangle_from_corners(corners, seen)
        if T is not None:
            T = pose(T[:3, :3] @ turn, T[:3, 3])
            found += [T, mirrored(T)]
    return found


def _clipped_rectangle_starts(shape: Rectangle, box: Box) -> list[NDArray[np.float64]]:
    found = []
    for seen in (box, box.turned()):
        # what is cut off or tilted looks small, so the nearer reading is the better one
        distance = min(shape.width_m / seen.across, shape.height_m / seen.along)
        middle = seen.centre(shape.width_m / distance, shape.height_m / distance)
        centre = np.append(middle, 1.0) * distance
        R = facing(np.append(seen.up, 0.0), centre)
        found += [pose(R @ _turns(*turns), centre) for turns in TURNS_RAD]
    return found


def _turns(about_x: float, about_y: float) -> NDArray[np.float64]:
    cx, sx = math.cos(about_x), math.sin(about_x)
    cy, sy = math.cos(about_y), math.sin(about_y)
    Rx = np.array([[1.0, 0.0, 0.0], [0.0, cx, -sx], [0.0, sx, cx]])
    Ry = np.array([[cy, 0.0, sy], [0.0, 1.0, 0.0], [-sy, 0.0, cy]])
    return Rx @ Ry
