"""Views of a rectangle as a known camera would see them, point by point, without pictures."""

import numpy as np

from hal.types import HeadAngles
from naod.calibration.lens import project
from naod.calibration.rig import Estimate, Rig
from naod.calibration.view import EdgePoints, View, corners_in_object, on_edges
from naod.geometry.transforms import inverse, rot_x, rot_y, rot_z, transform
from naod.pose.objects import Rectangle

SHAPE = Rectangle(width_m=0.30, height_m=0.20)
LENS = np.array([598.0, 598.4, 319.5, 239.5, 0.0])
PLAIN = np.zeros(4)
ASKEW = np.radians([5.0, -5.0, 5.0])
# the rectangle's x, y, z axes: to the robot's right, up, towards the robot
FACING = np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
T_TORSO_OBJECT = transform(FACING @ rot_y(0.3) @ rot_x(-0.1), (0.85, 0.05, 0.15))
HEADS = [HeadAngles(yaw, pitch) for pitch in (-0.2, 0.0, 0.2) for yaw in (-0.25, -0.1, 0.1, 0.25)]


def truth(correction=ASKEW, lens=LENS, heads=HEADS):
    return Estimate(correction, lens, 0.0, T_TORSO_OBJECT, np.zeros((len(heads), 2)))


def seen(rig, at, head, number, points):
    return rig.pixels(at, head, number, points)[0]


def view_of(rig, at, number, head, rng=None, noise_px=0.0, per_edge=24):
    corners = corners_in_object(SHAPE)
    edge = np.repeat(np.arange(4), per_edge)
    along = np.tile((np.arange(per_edge) + 0.5) / per_edge, 4)
    points = seen(rig, at, head, number, on_edges(corners, edge, along))
    ahead = seen(rig, at, head, number, on_edges(corners, edge, along + 1e-4)) - points
    ahead /= np.linalg.norm(ahead, axis=1)[:, None]
    normals = np.column_stack([ahead[:, 1], -ahead[:, 0]])
    if rng is not None:
        points = points + normals * rng.normal(0.0, noise_px, len(points))[:, None]
    sigma = np.full(len(points), max(noise_px, 0.02))
    T = inverse(rig.T_torso_camera(head, at.correction_rad)) @ at.T_torso_object
    return View(head, EdgePoints(points, normals, sigma, edge, along), T)


def views_of(rig, at, heads=HEADS, rng=None, noise_px=0.0, head_noise_rad=0.0):
    """What is seen, and told, when the encoders are off by some noise."""
    told = []
    for number, head in enumerate(heads):
        view = view_of(rig, at, number, head, rng, noise_px)
        off = rng.normal(0.0, head_noise_rad, 2) if rng is not None else np.zeros(2)
        said = HeadAngles(head.yaw_rad + off[0], head.pitch_rad + off[1])
        told.append(View(said, view.edges, view.T_camera_object))
    return told


def rig(camera="top", others=PLAIN):
    return Rig(camera, others)


__all__ = ["ASKEW", "LENS", "SHAPE", "project", "rig", "rot_z", "truth", "views_of"]
