"""Pictures of true shapes: a ray through every sample, asked whether it meets the solid.

Knows nothing of outlines, so that what the estimators derive from them is checked from outside.
"""

import numpy as np

from naod.geometry.camera import PinholeCamera, nominal_camera
from naod.geometry.transforms import rot_x, rot_y, rot_z, transform
from naod.pose.objects import Cylinder, Rectangle

CAMERA = nominal_camera("v6", 640, 480)
CAN = Cylinder(radius_m=0.033, height_m=0.122)
BOARD = Rectangle(width_m=0.30, height_m=0.20)


def can_pose(place, tilt=0.0, roll=0.0):
    """y up along the can, tilted towards the viewer by `tilt`; z to the camera by convention."""
    R = rot_z(roll) @ rot_x(np.pi + tilt)
    return towards_camera(transform(R, place))


def towards_camera(T):
    """The same axis, z perpendicular to it towards the camera."""
    y, centre = T[:3, 1], T[:3, 3]
    z = -centre + (centre @ y) * y
    z /= np.linalg.norm(z)
    return transform(np.column_stack([np.cross(y, z), y, z]), centre)


def board_pose(place, tilt=0.0, turn=0.0, roll=0.0):
    return transform(rot_z(roll) @ rot_x(np.pi + tilt) @ rot_y(turn), place)


def _meets_cylinder(shape, eye, rays):
    half = shape.height_m / 2.0
    a = rays[:, 0] ** 2 + rays[:, 2] ** 2
    b = rays[:, 0] * eye[0] + rays[:, 2] * eye[2]
    c = eye[0] ** 2 + eye[2] ** 2 - shape.radius_m**2
    inside = b * b - a * c
    root = np.sqrt(np.maximum(inside, 0.0))
    with np.errstate(divide="ignore"):
        caps = np.sort(np.stack([(-half - eye[1]) / rays[:, 1], (half - eye[1]) / rays[:, 1]]), 0)
    enter = np.maximum((-b - root) / a, caps[0])
    leave = np.minimum((-b + root) / a, caps[1])
    return (inside > 0.0) & (leave > np.maximum(enter, 0.0))


def _meets_rectangle(shape, eye, rays):
    with np.errstate(divide="ignore"):
        s = -eye[2] / rays[:, 2]
    x, y = eye[0] + s * rays[:, 0], eye[1] + s * rays[:, 1]
    return (s > 0.0) & (np.abs(x) < shape.width_m / 2.0) & (np.abs(y) < shape.height_m / 2.0)


def meets(shape, T, camera: PinholeCamera, pixels):
    """(n,) bool: does the ray through each pixel place (n, 2) meet the shape at T?"""
    rays = np.column_stack([camera.normalised(pixels), np.ones(len(pixels))]) @ T[:3, :3]
    eye = -T[:3, :3].T @ T[:3, 3]
    test = _meets_cylinder if isinstance(shape, Cylinder) else _meets_rectangle
    return test(shape, eye, rays)


def _window(shape, T, camera):
    """Columns and rows that a ball around the object covers."""
    size = (
        np.hypot(shape.radius_m, shape.height_m / 2.0)
        if isinstance(shape, Cylinder)
        else np.hypot(shape.width_m, shape.height_m) / 2.0
    )
    centre = camera.project(T[:3, 3][None])[0]
    reach = 1.3 * size / (T[2, 3] - size) * max(camera.fx, camera.fy) + 4.0
    left, top = np.maximum(np.floor(centre - reach), 0.0).astype(int)
    right, bottom = np.minimum(np.ceil(centre + reach), (camera.width, camera.height)).astype(int)
    return left, top, max(right, left), max(bottom, top)


def coverage(shape, T, camera=CAMERA, samples=1):
    """(H, W) share of each pixel that shows the shape, from samples x samples rays."""
    left, top, right, bottom = _window(shape, T, camera)
    out = np.zeros((camera.height, camera.width))
    places = (np.arange(samples) + 0.5) / samples - 0.5
    x, y = np.meshgrid(np.arange(left, right), np.arange(top, bottom))
    for dx in places:
        for dy in places:
            pixels = np.column_stack([x.ravel() + dx, y.ravel() + dy])
            hit = meets(shape, T, camera, pixels).reshape(x.shape)
            out[top:bottom, left:right] += hit / samples**2
    return out


def mask_of(shape, T, camera=CAMERA):
    """(H, W) uint8, 1 where the middle of the pixel shows the shape."""
    return coverage(shape, T, camera).astype(np.uint8)


def encoded(light):
    """sRGB levels, 0 to 255, of light 0 to 1."""
    return 255.0 * np.where(
        light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055
    )


def picture(covered, inside, outside, noise, rng):
    """RGB levels (H, W, 3) of a plain object before a plain wall; colours are light, 0 to 1."""
    share = covered[..., None]
    light = share * np.array(inside) + (1.0 - share) * np.array(outside)
    return np.clip(encoded(light) + rng.normal(0.0, noise, light.shape), 0.0, 255.0)
