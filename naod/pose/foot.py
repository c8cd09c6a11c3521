"""The point of an outline nearest to a point of the plane z = 1."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.pose.contour import ARC, CYLINDER, is_arc

STRIDE = 5
"""Of the corners looked at first, a divisor of their number."""


@njit(cache=True, nogil=True)
def _foot_on(image: NDArray[np.float64], k: int, u: float, v: float) -> tuple[float, float]:
    """Squared distance of (u, v) from a piece, and how far along it the foot lies, 0 to 1."""
    du, dv = image[k + 1, 0] - image[k, 0], image[k + 1, 1] - image[k, 1]
    length2 = du * du + dv * dv
    if length2 < 1e-18:
        return np.inf, 0.0
    s = ((u - image[k, 0]) * du + (v - image[k, 1]) * dv) / length2
    s = min(max(s, 0.0), 1.0)
    ru, rv = u - image[k, 0] - s * du, v - image[k, 1] - s * dv
    return ru * ru + rv * rv, s


@njit(cache=True, nogil=True)
def _gap2(image: NDArray[np.float64], k: int, u: float, v: float) -> float:
    ru, rv = u - image[k, 0], v - image[k, 1]
    return ru * ru + rv * rv


@njit(cache=True, nogil=True)
def _corner(image: NDArray[np.float64], pieces: int, u: float, v: float, near: int) -> int:
    """The corner nearest to (u, v), downhill from one that is near it; from the best if negative.

    Outlines are convex, so that from outside all ways down lead to the same corner.
    """
    if near < 0:
        near, least = 0, np.inf
        for k in range(0, pieces, STRIDE):
            gap2 = _gap2(image, k, u, v)
            if gap2 < least:
                near, least = k, gap2
    else:
        least = _gap2(image, near, u, v)
    first = near
    while True:
        after = near + 1 if near + 1 < pieces else 0
        gap2 = _gap2(image, after, u, v)
        if not gap2 < least:
            break
        near, least = after, gap2
    if near != first:
        return near
    while True:
        before = near - 1 if near > 0 else pieces - 1
        gap2 = _gap2(image, before, u, v)
        if not gap2 < least:
            return near
        near, least = before, gap2


@njit(cache=True, nogil=True)
def nearest(
    kind: int, image: NDArray[np.float64], pieces: int, u: float, v: float, near: int
) -> tuple[int, float, int]:
    """The piece of the outline nearest to (u, v), how far along it the foot lies, and its corner.

    near: a corner to begin at, negative where none is known.
    """
    if kind == CYLINDER:
        near = _corner(image, pieces, u, v, near)
        # either side of the nearest corner, and the two long straight pieces
        candidates = (near, near - 1 if near > 0 else pieces - 1, ARC, 2 * ARC + 1)
    else:
        candidates = (0, 1, 2, 3)
    best, piece, along = np.inf, 0, 0.0
    for k in candidates:
        distance2, s = _foot_on(image, k, u, v)
        if distance2 < best:
            best, piece, along = distance2, k, s
    return piece, along, near


@njit(cache=True, nogil=True)
def foot(
    kind: int,
    radius: float,
    vertices: NDArray[np.float64],
    edge: int,
    piece: int,
    part: float,
    X: NDArray[np.float64],
) -> None:
    """The point of the object at a part of a piece; of an arc's, the one out there on the rim."""
    for k in range(3):
        X[k] = vertices[piece, k] + part * (vertices[piece + 1, k] - vertices[piece, k])
    if is_arc(kind, edge):
        outwards = radius / max(math.sqrt(X[0] * X[0] + X[2] * X[2]), 1e-12)
        X[0] *= outwards
        X[2] *= outwards


@njit(cache=True, nogil=True)
def tangent(
    R: NDArray[np.float64], X: NDArray[np.float64], u: float, v: float, du: float, dv: float
) -> tuple[float, float]:
    """Direction of a rim at its point X, seen at (u, v); the chord's where the rim turns sharply.

    A rim seen from its own height is a line there and back, and no tangent where it turns.
    """
    x = R[0, 0] * X[2] - R[0, 2] * X[0]
    y = R[1, 0] * X[2] - R[1, 2] * X[0]
    z = R[2, 0] * X[2] - R[2, 2] * X[0]
    tu, tv = x - u * z, y - v * z
    along = tu * du + tv * dv
    if along * along < 0.81 * (tu * tu + tv * tv) * (du * du + dv * dv):
        return du, dv
    return (tu, tv) if along > 0.0 else (-tu, -tv)
