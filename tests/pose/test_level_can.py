"""A can seen from its own height: its rims change over there, and no slope leads across."""

from itertools import pairwise

import numpy as np
import pytest
from raster import CAMERA, CAN, can_pose

from naod.pose.contour import outline_in_camera
from naod.pose.explore import angle_between
from naod.pose.fit import fit_outline

FOCAL_PX = CAMERA.fx
GRAIN_PX = 4.0


def points_around(T, count, noise_px, rng):
    points, _ = outline_in_camera(CAN, T)
    u, v = (points[:, :2] / points[:, 2:]).T
    along = np.append(0.0, np.cumsum(np.hypot(np.diff(u), np.diff(v))))
    at = np.linspace(0.0, along[-1], count, endpoint=False)
    on_plane = np.stack([np.interp(at, along, u), np.interp(at, along, v)], axis=1)
    return on_plane + rng.normal(0.0, noise_px / FOCAL_PX, (count, 2))


@pytest.mark.parametrize("tilt", [0.0, 0.02, 0.05])
def test_a_descent_comes_to_rest_near_level(tilt):
    start = can_pose((0.02, 0.03, 0.85), tilt + 0.35, 0.05)
    for seed in range(10):
        rng = np.random.default_rng(seed)
        points = points_around(can_pose((0.02, 0.03, 0.9), tilt, 0.05), 48, 1.2, rng)
        last = [
            fit_outline(CAN, start, points, FOCAL_PX, 0.6 * GRAIN_PX, iterations=n)
            for n in (11, 12, 13)
        ]
        turns = [
            angle_between(a.T_camera_object[:3], b.T_camera_object[:3]) for a, b in pairwise(last)
        ]
        assert max(turns) < 0.02
        assert abs(last[-1].T_camera_object[2, 3] - 0.9) < 0.02
