"""The pose of a cylinder from the lines of its sides: another way to what the fit finds."""

import numpy as np

from naod.geometry.transforms import transform
from naod.pose.frames import facing


def cylinder_from_sides(left, right, ends, shape):
    """The pose (4, 4), exact for any tilt.

    `left`, `right`: (3,) normals of planes through the camera, pointing outwards. `ends`: (2,)
    each, where the middles of the upper and lower end are seen. The axis is along the cross product
    of the normals, in the bisecting plane, at r / sin(half the angle between the planes).
    """
    n1, n2 = left / np.linalg.norm(left), right / np.linalg.norm(right)
    axis = np.cross(n1, n2)
    axis /= np.linalg.norm(axis)
    # the axis' nearest point lies r inside both planes
    nearest = -(n1 + n2) * (shape.radius_m / (1.0 + n1 @ n2))
    upper, lower = (_along(nearest, axis, np.append(end, 1.0)) for end in ends)
    centre = nearest + axis * (upper + lower) / 2.0
    return transform(facing(axis if upper > lower else -axis, centre), centre)


def _along(foot, axis, ray):
    """Where on foot + s axis, foot being perpendicular to axis, a ray comes nearest to it."""
    d = ray / np.linalg.norm(ray)
    slope = axis @ d
    return (foot @ d) * slope / (1.0 - slope**2)
