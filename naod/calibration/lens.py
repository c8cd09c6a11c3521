"""Projection of points in the camera by OpenCV's model, with its derivatives."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FX, FY, CX, CY, K1 = range(5)


def project(
    points: NDArray[np.float64], lens: NDArray[np.float64], others: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Points (n, 3) in the camera to pixels (n, 2), (n, 2, 3) by the point, (n, 2, 5) by the lens.

    lens: (5,) fx, fy, cx, cy, k1. others: (4,) k2, p1, p2, k3, which stay as they are.
    """
    z = points[:, 2]
    a, b = points[:, 0] / z, points[:, 1] / z
    k2, p1, p2, k3 = others
    s = a * a + b * b
    radial = 1.0 + s * (lens[K1] + s * (k2 + s * k3))
    slope = lens[K1] + s * (2.0 * k2 + 3.0 * s * k3)
    x = a * radial + 2.0 * p1 * a * b + p2 * (s + 2.0 * a * a)
    y = b * radial + p1 * (s + 2.0 * b * b) + 2.0 * p2 * a * b
    by_plane = np.empty((len(points), 2, 2))
    by_plane[:, 0, 0] = radial + 2.0 * a * a * slope + 2.0 * p1 * b + 6.0 * p2 * a
    by_plane[:, 0, 1] = 2.0 * a * b * slope + 2.0 * p1 * a + 2.0 * p2 * b
    by_plane[:, 1, 0] = by_plane[:, 0, 1]
    by_plane[:, 1, 1] = radial + 2.0 * b * b * slope + 6.0 * p1 * b + 2.0 * p2 * a
    focal = lens[[FX, FY]]
    pixels = np.column_stack([x, y]) * focal + lens[[CX, CY]]

    to_plane = np.zeros((len(points), 2, 3))
    to_plane[:, 0, 0] = to_plane[:, 1, 1] = 1.0 / z
    to_plane[:, 0, 2], to_plane[:, 1, 2] = -a / z, -b / z
    by_point = focal[None, :, None] * (by_plane @ to_plane)

    by_lens = np.zeros((len(points), 2, 5))
    by_lens[:, 0, FX], by_lens[:, 1, FY] = x, y
    by_lens[:, 0, CX] = by_lens[:, 1, CY] = 1.0
    by_lens[:, 0, K1], by_lens[:, 1, K1] = focal[0] * a * s, focal[1] * b * s
    return pixels, by_point, by_lens
