"""Poses to start from for a box or a quadrilateral on the plane z = 1, without a library call.

An outline leaves a sign open that only perspective decides (a can tilted towards the viewer or
away, a board turned left or right), so there are always several.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.geometry.vectors import cross, dot, unit
from naod.pose.contour import CYLINDER

GUESSES_MAX = 12
RATIO_SLACK = 1.25
OTHERS_MAX = 3
TILT_LEAST_RAD, TILT_MOST_RAD = 0.15, 1.2
CUT_TILTS_RAD = (0.3, 0.75)
"""Of a can of which the box does not show the height, towards the viewer and away."""

CUT_TURNS_RAD = ((0.0, 0.0), (0.6, 0.0), (-0.6, 0.0), (0.0, 0.6), (0.0, -0.6))
"""Of a clipped board about its x and y."""

HIDDEN_SLACK = 0.15


@njit(cache=True, nogil=True)
def put(
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    z: NDArray[np.float64],
    t: NDArray[np.float64],
    T: NDArray[np.float64],
) -> None:
    """A pose (3, 4) from its columns."""
    for k in range(3):
        T[k, 0], T[k, 1], T[k, 2], T[k, 3] = x[k], y[k], z[k], t[k]


@njit(cache=True, nogil=True)
def face(axis: NDArray[np.float64], centre: NDArray[np.float64], T: NDArray[np.float64]) -> None:
    """The pose (3, 4) whose y is along `axis` and whose z looks towards the camera."""
    y = unit(axis)
    z = -centre + dot(centre, y) * y
    if dot(z, z) < 1e-18 * dot(centre, centre):
        # seen exactly along its axis: any z will do
        other = np.zeros(3)
        other[0 if abs(y[0]) < 0.9 else 1] = 1.0
        z = cross(y, other)
    z = unit(z)
    put(cross(y, z), y, z, centre, T)


@njit(cache=True, nogil=True)
def mirror(T: NDArray[np.float64], out: NDArray[np.float64]) -> None:
    """The other reading of a flat thing (3, 4): seen from afar, what points away points here.

    Both axes in the plane are reflected along the line of sight, which shows no difference there.
    """
    t = T[:, 3].copy()
    forward = unit(t)
    x = T[:, 0] - 2.0 * dot(T[:, 0], forward) * forward
    y = T[:, 1] - 2.0 * dot(T[:, 1], forward) * forward
    put(x, y, cross(x, y), t, out)


@njit(cache=True, nogil=True)
def tilted(T: NDArray[np.float64], tilt: float, out: NDArray[np.float64]) -> None:
    """A can (3, 4) where it is, its axis tilted so far towards the viewer."""
    t = T[:, 3].copy()
    forward = unit(t)
    up = T[:, 1] - dot(T[:, 1], forward) * forward
    face(math.cos(tilt) * unit(up) - math.sin(tilt) * forward, t, out)


@njit(cache=True, nogil=True)
def _box(corners: NDArray[np.float64], turn: int) -> tuple[float, float, float, float]:
    """Across and along of a box, and its unit vector upwards, after so many quarter turns."""
    a, b = corners[turn % 4], corners[(1 + turn) % 4]
    c, d = corners[(2 + turn) % 4], corners[(3 + turn) % 4]
    across = 0.5 * (math.hypot(b[0] - a[0], b[1] - a[1]) + math.hypot(c[0] - d[0], c[1] - d[1]))
    along = 0.5 * (math.hypot(d[0] - a[0], d[1] - a[1]) + math.hypot(c[0] - b[0], c[1] - b[1]))
    ux, uy = a[0] + b[0] - c[0] - d[0], a[1] + b[1] - c[1] - d[1]
    length = max(math.hypot(ux, uy), 1e-12)
    return max(across, 1e-9), max(along, 1e-9), ux / length, uy / length


@njit(cache=True, nogil=True)
def _centre(
    corners: NDArray[np.float64],
    cut: NDArray[np.bool_],
    turn: int,
    size: tuple[float, float],
    out: NDArray[np.float64],
) -> None:
    """Ray to the middle of an object of a size (across, along), held by the whole edges."""
    across, along, ux, uy = _box(corners, turn)
    lack_along = 0.5 * (size[1] - along) * (int(cut[turn % 4]) - int(cut[(2 + turn) % 4]))
    lack_across = 0.5 * (size[0] - across) * (int(cut[(1 + turn) % 4]) - int(cut[(3 + turn) % 4]))
    out[0] = corners[:, 0].mean() + ux * lack_along - uy * lack_across
    out[1] = corners[:, 1].mean() + uy * lack_along + ux * lack_across
    out[2] = 1.0


@njit(cache=True, nogil=True)
def _tilts(ratio: float, level: float, cut: bool, tilts: NDArray[np.float64]) -> int:
    """Magnitudes of tilt at which a can looks so much higher than wide."""
    if cut:
        tilts[0], tilts[1] = CUT_TILTS_RAD
        return 2
    highest = math.hypot(level, 1.0)
    best, aside = math.atan2(1.0, level), math.acos(min(max(ratio / highest, -1.0), 1.0))
    tilts[0] = min(max(abs(best - aside), TILT_LEAST_RAD), TILT_MOST_RAD)
    tilts[1] = min(best + aside, TILT_MOST_RAD)
    return 2 if tilts[1] - tilts[0] > 0.2 else 1


@njit(cache=True, nogil=True)
def cylinder_guesses(
    radius: float,
    half_height: float,
    corners: NDArray[np.float64],
    cut: NDArray[np.bool_],
    out: NDArray[np.float64],
) -> int:
    """Poses (GUESSES_MAX, 3, 4) for a box; the axis along either side unless its shape says."""
    level, any_cut = half_height / radius, cut.any()
    least, most = min(level, 1.0) / RATIO_SLACK, math.hypot(level, 1.0) * RATIO_SLACK
    fits = np.zeros(2, dtype=np.bool_)
    for turn in range(2):
        across, along, _, _ = _box(corners, turn)
        fits[turn] = any_cut or least <= along / across <= most
    count, tilts, centre, up = 0, np.empty(2), np.empty(3), np.zeros(3)
    for turn in range(2):
        if fits.any() and not fits[turn]:
            continue
        across, along, up[0], up[1] = _box(corners, turn)
        distance = radius / math.sin(math.atan(across / 2.0))
        size = across, along
        if any_cut:
            distance = min(distance, 2.0 * half_height / along)
            size = 2.0 * radius / distance, 2.0 * half_height / distance
        _centre(corners, cut, turn, size, centre)
        forward, t = unit(centre), centre * distance
        upright = unit(up - dot(up, forward) * forward)
        for k in range(_tilts(along / across, level, any_cut, tilts)):
            for sign in (1.0, -1.0):
                tilt = sign * tilts[k]
                face(math.cos(tilt) * upright - math.sin(tilt) * forward, t, out[count])
                count += 1
    return count


@njit(cache=True, nogil=True)
def rectangle_from_quadrilateral(
    half_width: float,
    half_height: float,
    corners: NDArray[np.float64],
    turn: int,
    T: NDArray[np.float64],
) -> bool:
    """The pose (3, 4) of a rectangle by the homography that takes it to corners (4, 2).

    corners: top left, top right, bottom right, bottom left, after `turn` quarter turns. The axes
    are made perpendicular without preferring one. False: no picture of a rectangle in front.
    """
    a, b = corners[turn % 4], corners[(1 + turn) % 4]
    c, d = corners[(2 + turn) % 4], corners[(3 + turn) % 4]
    x1, y1, x2, y2 = b[0] - c[0], b[1] - c[1], d[0] - c[0], d[1] - c[1]
    x3, y3 = a[0] - b[0] + c[0] - d[0], a[1] - b[1] + c[1] - d[1]
    turned = x1 * y2 - x2 * y1
    if abs(turned) < 1e-12:
        return False
    g, h = (x3 * y2 - x2 * y3) / turned, (x1 * y3 - x3 * y1) / turned
    right, down, first = np.empty(3), np.empty(3), np.ones(3)
    first[:2] = a
    right[:2], right[2] = b - a + g * b, g
    down[:2], down[2] = d - a + h * d, h
    scale = math.sqrt(dot(right, right)) / half_width + math.sqrt(dot(down, down)) / half_height
    if not scale > 1e-12:
        return False
    along, across = unit(unit(right) - unit(down)), unit(unit(right) + unit(down))
    x, y = unit(across + along), unit(along - across)
    z, t = cross(x, y), first * (4.0 / scale) + half_width * x - half_height * y
    put(x, y, z, t, T)
    return t[2] > 0.0 and dot(z, t) < 0.0


@njit(cache=True, nogil=True)
def rectangle_guesses(
    half_width: float, half_height: float, corners: NDArray[np.float64], out: NDArray[np.float64]
) -> int:
    """Poses for a quadrilateral: either side may be the width, and either tilt the true one."""
    count = 0
    for turn in range(2):
        if rectangle_from_quadrilateral(half_width, half_height, corners, turn, out[count]):
            mirror(out[count], out[count + 1])
            count += 2
    return count


@njit(cache=True, nogil=True)
def cut_rectangle_guesses(
    half_width: float,
    half_height: float,
    corners: NDArray[np.float64],
    cut: NDArray[np.bool_],
    out: NDArray[np.float64],
) -> int:
    """Fixed tilts for a box of which three edges show little.

    Which side is the width three edges cannot say: the less of the board would have to be out of
    sight, the likelier.
    """
    distances, hidden = np.empty(2), np.empty(2)
    for turn in range(2):
        across, along, _, _ = _box(corners, turn)
        # what is cut off or tilted looks small, so the nearer reading is the better one
        distances[turn] = min(2.0 * half_width / across, 2.0 * half_height / along)
        hidden[turn] = 1.0 - distances[turn] * min(
            across / (2.0 * half_width), along / (2.0 * half_height)
        )
    count, centre, up, T = 0, np.empty(3), np.zeros(3), np.empty((3, 4))
    for turn in range(2):
        if hidden[turn] > hidden.min() + HIDDEN_SLACK:
            continue
        distance = distances[turn]
        _, _, up[0], up[1] = _box(corners, turn)
        size = 2.0 * half_width / distance, 2.0 * half_height / distance
        _centre(corners, cut, turn, size, centre)
        face(up, centre * distance, T)
        for about_x, about_y in CUT_TURNS_RAD:
            if count < out.shape[0]:
                _turned(T, about_x, about_y, out[count])
                count += 1
    return count


@njit(cache=True, nogil=True)
def _turned(
    T: NDArray[np.float64], about_x: float, about_y: float, out: NDArray[np.float64]
) -> None:
    """A pose turned about its own x, then its own y."""
    x, y, z = T[:, 0].copy(), T[:, 1].copy(), T[:, 2].copy()
    y, z = (
        math.cos(about_x) * y + math.sin(about_x) * z,
        math.cos(about_x) * z - math.sin(about_x) * y,
    )
    x, z = (
        math.cos(about_y) * x - math.sin(about_y) * z,
        math.cos(about_y) * z + math.sin(about_y) * x,
    )
    put(x, y, z, T[:, 3].copy(), out)


@njit(cache=True, nogil=True)
def other_readings(
    kind: int,
    half_width: float,
    half_height: float,
    T: NDArray[np.float64],
    out: NDArray[np.float64],
) -> int:
    """A pose found, (3, 4), and those that look nearly like it, up to OTHERS_MAX of them.

    A can that is tilted more than its diagonal looks as high as one that is tilted less.
    """
    out[0] = T
    if kind != CYLINDER:
        mirror(T, out[1])
        return 2
    forward = unit(T[:, 3].copy())
    tilt = math.asin(min(max(-dot(T[:, 1], forward), -1.0), 1.0))
    tilted(T, -math.copysign(max(abs(tilt), TILT_LEAST_RAD), tilt), out[1])
    as_high = max(2.0 * math.atan2(half_width, half_height) - abs(tilt), TILT_LEAST_RAD)
    tilted(T, math.copysign(min(as_high, TILT_MOST_RAD), tilt), out[2])
    return 3
