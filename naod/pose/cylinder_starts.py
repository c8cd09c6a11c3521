"""Where the search for a cylinder starts: a closed form, and tilts to and fro."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from naod.pose.box import Box, line_through
from naod.pose.frames import cross, facing, pose
from naod.pose.objects import Cylinder

TILTS_RAD = (0.75, 0.3, -0.3, -0.75)
"""Of the axis towards the viewer."""

NEXT_TILTS_RAD = (0.45, -0.45)
"""The same where a pose is known already."""

RATIO_SLACK = 1.25


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


def first_cylinder_starts(
    shape: Cylinder, box: Box, points: NDArray[np.float64]
) -> list[NDArray[np.float64]]:
    """Poses (4, 4) for a box and the edge points (n, 2) in it, both on the plane z = 1.

    The axis may run along either side of the box, unless its proportions say which.
    """
    ways = [seen for seen in (box, box.turned()) if seen.cut.any() or _may_be(shape, seen)]
    found: list[NDArray[np.float64]] = []
    for seen in ways or (box, box.turned()):
        found += _tilted_cylinders(shape, seen)
        if not seen.cut.any():
            found += _closed_form(shape, seen, points)
    return found


def next_cylinder_starts(T: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """A pose (4, 4) found before, and the same tilted otherwise."""
    centre = T[:3, 3]
    forward = centre / np.linalg.norm(centre)
    up = T[:3, 1] - (T[:3, 1] @ forward) * forward
    if up @ up < 1e-12:
        return [T]
    return [T, *_fan(up, forward, centre, NEXT_TILTS_RAD)]


def _may_be(shape: Cylinder, box: Box) -> bool:
    level = shape.height_m / (2.0 * shape.radius_m)
    least, most = min(level, 1.0) / RATIO_SLACK, math.hypot(level, 1.0) * RATIO_SLACK
    return least <= box.along / box.across <= most


def _closed_form(
    shape: Cylinder, box: Box, points: NDArray[np.float64]
) -> list[NDArray[np.float64]]:
    """From lines through the points along the box's sides; none where there are too few."""
    middle, up = box.corners.mean(axis=0), box.up
    right = np.array([-up[1], up[0]])
    high, aside = (points - middle) @ up, (points - middle) @ right
    on_sides = (np.abs(high) < 0.25 * box.along) & (np.abs(aside) > 0.3 * box.across)
    lines = []
    for outwards in (-right, right):
        line = line_through(points[on_sides & ((points - middle) @ outwards > 0.0)])
        if line is None:
            return []
        lines.append(line if line[:2] @ outwards > 0.0 else -line)
    if np.linalg.norm(cross(lines[0], lines[1])) < 1e-6:
        return []
    ends = box.corners[:2].mean(axis=0), box.corners[2:].mean(axis=0)
    found = cylinder_from_sides(lines[0], lines[1], ends, shape)
    return [found] if found[2, 3] > 0.0 else []


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
