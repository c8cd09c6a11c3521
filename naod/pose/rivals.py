"""Several poses that nearly fit the same edges: which fits best, and by how much."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.geometry.vectors import cross, dot, unit
from naod.pose.contour import CYLINDER, RECTANGLE, VERTICES, seen_outline
from naod.pose.explore import INDEPENDENT, READINGS, angle_between, unlikeliness
from naod.pose.guesses import put, tilted
from naod.pose.refine import fit_edges

OUTLIER = 3.0
"""Standard deviations beyond which a residual says no more than that it does not fit."""

SIGMA_LEAST_PX = 0.05
LEVEL_RAD = 0.01
NEARLY_LEVEL = 0.2
"""Sine of a tilt below which a can may as well be tilted the other way, or not at all."""

TILTED = 0.03
"""Sine of a tilt above which a can that is nearly level has been taken to be tilted."""

RIVALS_MAX = READINGS + 2
DISTINCT_RAD = 0.01
FACE_ON = 1.4
"""By how much the aspect of a board seen face on may be another than its own."""


@njit(cache=True, nogil=True)
def misfit_gap(
    first: NDArray[np.float64],
    first_groups: NDArray[np.int64],
    first_offsets: NDArray[np.float64],
    second: NDArray[np.float64],
    second_groups: NDArray[np.int64],
    second_offsets: NDArray[np.float64],
    spreads: NDArray[np.float64],
    trust: NDArray[np.float64],
) -> float:
    """By how much the second residuals (n,) are worse: squared deviations, cut at OUTLIER.

    Of the points from their groups' offsets (4,), and of those from none.
    """
    n = first.size
    one, two = np.empty(n), np.empty(n)
    for i in range(n):
        one[i] = abs(first[i] - first_offsets[first_groups[i]])
        two[i] = abs(second[i] - second_offsets[second_groups[i]])
    sigma = max(SIGMA_LEAST_PX, 1.4826 * min(np.median(one), np.median(two)))
    total = 0.0
    for i in range(n):
        scale = math.sqrt(trust[i]) / sigma
        total -= min(one[i] * scale, OUTLIER) ** 2
        total += min(two[i] * scale, OUTLIER) ** 2
    for k in range(4):
        if spreads[k] > 0.0:
            total -= min(abs(first_offsets[k]) / spreads[k], OUTLIER) ** 2
            total += min(abs(second_offsets[k]) / spreads[k], OUTLIER) ** 2
    return total


@njit(cache=True, nogil=True)
def add_rivals(
    kind: int,
    half_width: float,
    half_height: float,
    poses: NDArray[np.float64],
    count: int,
) -> int:
    """Add to poses (RIVALS_MAX, 3, 4) what looks nearly like the first; returns how many.

    A can seen nearly level may be level: there the outline changes over from the near side of a rim
    to the far one, and no descent comes across; and one that seems tilted may be half as tilted,
    from where a descent comes back from edges of other things. A board on its side, turned away,
    may be one that stands face on.
    """
    if kind != CYLINDER:
        return count + int(_upright(half_width, half_height, poses[0], poses[count]))
    along = away2 = 0.0
    for k in range(3):
        along += poses[0, k, 1] * poses[0, k, 3]
        away2 += poses[0, k, 3] ** 2
    if abs(along) > NEARLY_LEVEL * math.sqrt(away2):
        return count
    tilted(poses[0], math.copysign(LEVEL_RAD, -along), poses[count])
    if abs(along) < TILTED * math.sqrt(away2):
        return count + 1
    tilted(poses[0], -0.5 * math.asin(along / math.sqrt(away2)), poses[count + 1])
    return count + 2


@njit(cache=True, nogil=True)
def _upright(
    half_width: float,
    half_height: float,
    T: NDArray[np.float64],
    out: NDArray[np.float64],
) -> bool:
    """The board that a pose (3, 4) shows, face on and a quarter turned, if it looks like one."""
    seen, names = np.empty((VERTICES, 3)), np.empty(VERTICES, dtype=np.int64)
    seen_outline(RECTANGLE, half_width, half_height, T, seen, names)
    a, b, c, d = seen[1], seen[2], seen[3], seen[0]
    right, down = 0.5 * (b - a + c - d), 0.5 * (d - a + c - b)
    across, along = math.hypot(right[0], right[1]), math.hypot(down[0], down[1])
    if across < 1e-9 or along < 1e-9:
        return False
    aspect = across * half_height / (along * half_width)
    if not 1.0 / FACE_ON < aspect < FACE_ON:
        return False
    distance = 2.0 * math.sqrt(half_width * half_height / (across * along))
    t, x = np.ones(3), np.zeros(3)
    t[:2], x[:2] = 0.25 * (a + b + c + d)[:2], right[:2] / across
    z = unit(-t)
    x = unit(x - dot(x, z) * z)
    put(x, cross(z, x), z, t * distance, out)
    return True


@njit(cache=True, nogil=True)
def settle(
    kind: int,
    half_width: float,
    half_height: float,
    poses: NDArray[np.float64],
    count: int,
    points: NDArray[np.float64],
    sigmas: NDArray[np.float64],
    groups: NDArray[np.int64],
    lens: NDArray[np.float64],
    spreads: NDArray[np.float64],
    residuals: NDArray[np.float64],
    jacobian: NDArray[np.float64],
    edges: NDArray[np.int64],
    weights: NDArray[np.float64],
    trust: NDArray[np.float64],
    offsets: NDArray[np.float64],
) -> float:
    """Put the pose that fits edge points (n, 2) best first, and the next one second.

    poses: (RIVALS_MAX, 3, 4), the first already fitted, as `fit_edges` has it; the other arrays
    are its, and afterwards the best one's. Returns the gap between the two, infinite without a
    second.
    """
    n, gap = points.shape[0], np.inf
    new, slopes, names = np.empty(n), np.empty((n, 6)), np.empty(n, dtype=np.int64)
    new_weights, new_trust, new_offsets = np.empty(n), np.empty(n), np.empty(4)
    second = poses[0].copy()
    for k in range(1, count):
        rival = poses[k]
        if not fit_edges(
            kind, half_width, half_height, rival, points, sigmas, groups, lens, spreads,
            new, slopes, names, new_weights, new_trust, new_offsets,
        ):  # fmt: skip
            continue
        worse = misfit_gap(residuals, groups, offsets, new, groups, new_offsets, spreads, trust)
        worse += n / INDEPENDENT * (unlikeliness(kind, rival) - unlikeliness(kind, poses[0]))
        distinct = angle_between(rival, poses[0]) > DISTINCT_RAD
        if worse < 0.0:
            if distinct:
                gap = -worse
                second[:] = poses[0]
            poses[0] = rival
            residuals[:], jacobian[:], edges[:] = new, slopes, names
            weights[:], offsets[:] = new_weights, new_offsets
        elif distinct and worse < gap:
            gap = worse
            second[:] = rival
    poses[1] = second
    return gap
