"""Gauss-Newton: the pose whose outline passes through measured edge points.

Points and outline are compared on the plane z = 1. A point's residual is its distance from the
nearest piece of the outline, along that piece's outward normal. Sliding along the outline changes
nothing to first order, so its derivative is that of the point of the object lying there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.geometry.linear import solve_symmetric
from naod.geometry.transforms import closed
from naod.pose.contour import CYLINDER, DEPTH_MIN_M, VERTICES, figures, is_arc, outline, project
from naod.pose.foot import foot, nearest, tangent
from naod.pose.objects import ObjectShape
from naod.pose.shared import give_way, point_sigma

ITERATIONS = 12
SETTLED = 1e-5
TO_AND_FRO = 0.5
"""A turn that takes back so much of the one before has gone too far: where a can's rims change over
at level, whole steps would go to and fro."""

OUTLIER = 3.0
"""Robust standard deviations at which a point's weight has fallen to a quarter."""

SCATTER_LEAST = 0.2
"""Of the points of an edge about its offset, of the offset's own spread: no surer than that."""


@dataclass(frozen=True, slots=True)
class Fit:
    """A fitted pose and what it was fitted to.

    residuals: (n,) pixels, positive outside the outline. jacobian: (n, 6) of them by translation
    (m) and rotation (rad) about the object's origin, camera axes. edges: (n,) which edge. weights:
    (n,) in 0 to 1 after down-weighting outliers. groups: (n,) which points are off together,
    spreads: (4,) px by how much they may be, offsets: (4,) px by how much they seem to be.
    """

    T_camera_object: NDArray[np.float64]
    residuals: NDArray[np.float64]
    jacobian: NDArray[np.float64]
    edges: NDArray[np.int64]
    weights: NDArray[np.float64]
    groups: NDArray[np.int64]
    spreads: NDArray[np.float64]
    offsets: NDArray[np.float64]

    def cost(self, cut_px: float) -> float:
        """Mean squared residual, each cut at `cut_px`, px squared."""
        return float(np.mean(np.minimum(np.abs(self.residuals), cut_px) ** 2))


@njit(cache=True, nogil=True)
def compare(
    kind: int,
    half_width: float,
    half_height: float,
    R: NDArray[np.float64],
    t: NDArray[np.float64],
    points: NDArray[np.float64],
    corners: NDArray[np.int64],
    residuals: NDArray[np.float64],
    jacobian: NDArray[np.float64],
    edges: NDArray[np.int64],
) -> None:
    """Residuals (n,), Jacobian (n, 6) and edges (n,) of points (n, 2), all on the plane z = 1.

    corners: (n,) of the outline, the nearest to each point when last asked, negative where that is
    not known; they are brought up to date.
    """
    vertices, image = np.empty((VERTICES, 3)), np.empty((VERTICES, 3))
    names, X = np.empty(VERTICES, dtype=np.int64), np.empty(3)
    pieces = outline(kind, half_width, half_height, R, t, vertices, names)
    project(R, t, vertices, pieces + 1, image)
    for i in range(points.shape[0]):
        u, v = points[i, 0], points[i, 1]
        piece, s, corners[i] = nearest(kind, image, pieces, u, v, corners[i])
        near, far = image[piece, 2], image[piece + 1, 2]
        foot(kind, half_width, vertices, names[piece], piece,
              s * near / (s * near + (1.0 - s) * far), X)  # fmt: skip
        a0 = R[0, 0] * X[0] + R[0, 1] * X[1] + R[0, 2] * X[2]
        a1 = R[1, 0] * X[0] + R[1, 1] * X[1] + R[1, 2] * X[2]
        a2 = R[2, 0] * X[0] + R[2, 1] * X[1] + R[2, 2] * X[2]
        nearness = 1.0 / max(a2 + t[2], DEPTH_MIN_M)
        pu, pv = (a0 + t[0]) * nearness, (a1 + t[1]) * nearness
        du, dv = image[piece + 1, 0] - image[piece, 0], image[piece + 1, 1] - image[piece, 1]
        if is_arc(kind, names[piece]):
            du, dv = tangent(R, X, pu, pv, du, dv)
        shorter = 1.0 / max(math.sqrt(du * du + dv * dv), 1e-12)
        nu, nv = dv * shorter, -du * shorter
        residuals[i] = nu * (u - pu) + nv * (v - pv)
        g0, g1, g2 = nu * nearness, nv * nearness, -(nu * pu + nv * pv) * nearness
        jacobian[i, 0], jacobian[i, 1], jacobian[i, 2] = -g0, -g1, -g2
        jacobian[i, 3] = -(a1 * g2 - a2 * g1)
        jacobian[i, 4] = -(a2 * g0 - a0 * g2)
        jacobian[i, 5] = -(a0 * g1 - a1 * g0)
        edges[i] = names[piece]


@njit(cache=True, nogil=True)
def robust_weights(
    residuals: NDArray[np.float64],
    groups: NDArray[np.int64],
    offsets: NDArray[np.float64],
    floor: float,
    weights: NDArray[np.float64],
) -> None:
    """Geman-McClure weights by the median of the residuals beyond their groups' offsets (4,)."""
    for i in range(residuals.size):
        weights[i] = abs(residuals[i] - offsets[groups[i]])
    scale = max(floor, 1.4826 * float(np.median(weights)))
    for i in range(residuals.size):
        ratio = weights[i] / (OUTLIER * scale)
        weights[i] = 1.0 / (1.0 + ratio * ratio) ** 2


@njit(cache=True, nogil=True)
def _turn(R: NDArray[np.float64], wx: float, wy: float, wz: float) -> None:
    """R becomes exp(w) R, by Rodrigues' formula."""
    angle = math.sqrt(wx * wx + wy * wy + wz * wz)
    if angle < 1e-12:
        return
    x, y, z = wx / angle, wy / angle, wz / angle
    c, s = math.cos(angle), math.sin(angle)
    d = 1.0 - c
    for j in range(3):
        a0, a1, a2 = R[0, j], R[1, j], R[2, j]
        R[0, j] = (c + d * x * x) * a0 + (d * x * y - s * z) * a1 + (d * x * z + s * y) * a2
        R[1, j] = (d * x * y + s * z) * a0 + (c + d * y * y) * a1 + (d * y * z - s * x) * a2
        R[2, j] = (d * x * z - s * y) * a0 + (d * y * z + s * x) * a1 + (c + d * z * z) * a2


@njit(cache=True, nogil=True)
def _normal_equations(
    kind: int,
    R: NDArray[np.float64],
    residuals: NDArray[np.float64],
    jacobian: NDArray[np.float64],
    groups: NDArray[np.int64],
    weights: NDArray[np.float64],
    trust: NDArray[np.float64],
    spreads: NDArray[np.float64],
    offsets: NDArray[np.float64],
    A: NDArray[np.float64],
    b: NDArray[np.float64],
) -> None:
    A[:] = 0.0
    b[:] = 0.0
    pulls, sums = np.zeros((4, 6)), np.zeros((2, 4))
    for i in range(residuals.size):
        weight, edge = weights[i] * trust[i], groups[i]
        sums[0, edge] += weight
        sums[1, edge] += weight * residuals[i]
        for j in range(6):
            weighted = weight * jacobian[i, j]
            pulls[edge, j] += weighted
            b[j] -= weighted * residuals[i]
            for k in range(j + 1):
                A[j, k] += weighted * jacobian[i, k]
    if spreads.any():
        least = SCATTER_LEAST * spreads.max()
        sigma = point_sigma(residuals, weights, trust, groups, offsets, least)
        give_way(pulls, sums[0], sums[1], spreads, sigma, offsets, np.empty(4), A, b)
    if kind == CYLINDER:
        # the turn about its own axis is not seen: hold it
        stiff = A[3, 3] + A[4, 4] + A[5, 5]
        for j in range(3):
            for k in range(j + 1):
                A[3 + j, 3 + k] += stiff * R[j, 1] * R[k, 1]
    for j in range(6):
        A[j, j] += 1e-4 * A[j, j] + 1e-9


@njit(cache=True, nogil=True)
def descend(
    kind: int,
    half_width: float,
    half_height: float,
    T: NDArray[np.float64],
    points: NDArray[np.float64],
    trust: NDArray[np.float64],
    groups: NDArray[np.int64],
    spreads: NDArray[np.float64],
    floor: float,
    iterations: int,
    settled: float,
    residuals: NDArray[np.float64],
    jacobian: NDArray[np.float64],
    edges: NDArray[np.int64],
    weights: NDArray[np.float64],
    offsets: NDArray[np.float64],
) -> None:
    """Gauss-Newton from T (3, 4), which is moved; the other arrays are as `compare` has them.

    floor: least scale of a residual on the plane z = 1. settled: step, of the distance and in
    rad / 10, below which it is done. groups (n,): which points have an offset in common; `edges`
    for those of the edge each is nearest to. spreads (4,): standard deviations of the groups'
    offsets, on that plane, 0 for none; offsets (4,): what they turn out to be.
    """
    A, b, step, before = np.empty((6, 6)), np.empty(6), np.empty(6), np.zeros(3)
    share = 1.0
    corners = np.full(points.shape[0], -1)
    R, t = T[:, :3].copy(), T[:, 3].copy()
    offsets[:] = 0.0
    for _ in range(iterations):
        compare(kind, half_width, half_height, R, t, points, corners, residuals, jacobian, edges)
        robust_weights(residuals, groups, offsets, floor, weights)
        _normal_equations(
            kind, R, residuals, jacobian, groups, weights, trust, spreads, offsets, A, b
        )
        if not solve_symmetric(A, b, step):
            break
        # no further at once than the distance to the object allows
        size = math.sqrt(step[0] ** 2 + step[1] ** 2 + step[2] ** 2) / (0.3 * abs(t[2]))
        turn = math.sqrt(step[3] ** 2 + step[4] ** 2 + step[5] ** 2) / 0.35
        along = square = 0.0
        for k in range(3):
            along += step[3 + k] * before[k]
            square += before[k] * before[k]
            before[k] = step[3 + k]
        if kind == CYLINDER and along < -TO_AND_FRO * square:
            share *= 0.5
        step *= share / max(1.0, size, turn)
        t += step[:3]
        t[2] = max(t[2], 2.0 * DEPTH_MIN_M)
        _turn(R, step[3], step[4], step[5])
        if share * max(size, 0.1 * turn) < settled:
            break
    compare(kind, half_width, half_height, R, t, points, corners, residuals, jacobian, edges)
    robust_weights(residuals, groups, offsets, floor, weights)
    T[:, :3], T[:, 3] = R, t


def fit_outline(
    shape: ObjectShape,
    start: NDArray[np.float64],
    points: NDArray[np.float64],
    focal_px: float,
    floor_px: float,
    trust: NDArray[np.float64] | None = None,
    iterations: int = ITERATIONS,
) -> Fit:
    """The pose whose outline fits points (n, 2) on the plane z = 1, from a start (4, 4).

    focal_px turns distances on that plane into pixels; floor_px is the least scale at which a
    residual counts as an outlier; trust (n,) are weights the points come with. No edge is taken to
    be off as a whole.
    """
    n = len(points)
    spreads, offsets = np.zeros(4), np.zeros(4)
    residuals, jacobian = np.empty(n), np.empty((n, 6))
    edges, weights = np.zeros(n, dtype=np.int64), np.empty(n)
    T = np.ascontiguousarray(start[:3], dtype=np.float64).copy()
    descend(
        *figures(shape),
        T,
        np.ascontiguousarray(points),
        np.ones(n) if trust is None else trust,
        edges,
        spreads,
        floor_px / focal_px,
        iterations,
        SETTLED,
        residuals,
        jacobian,
        edges,
        weights,
        offsets,
    )
    return Fit(
        closed(T),
        residuals * focal_px,
        jacobian * focal_px,
        edges,
        weights,
        edges,
        spreads,
        offsets * focal_px,
    )
