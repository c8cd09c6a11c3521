"""Places around an outline in pixels, with normals; how much of the picture it covers."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.pose.contour import VERTICES
from naod.pose.lens import HEIGHT, WIDTH, focal, to_pixel

CORNER_PX = 2.0
"""Near a corner there are two edges at once."""

PLACES_MIN = 12


@njit(cache=True, nogil=True)
def narrowest(image: NDArray[np.float64], pieces: int) -> float:
    """Least width of a closed outline on the plane z = 1, across one of its long pieces.

    Nothing where it is but a point.
    """
    longest = 0.0
    for k in range(pieces):
        du, dv = image[k + 1, 0] - image[k, 0], image[k + 1, 1] - image[k, 1]
        longest = max(longest, math.hypot(du, dv))
    best = np.inf
    for k in range(pieces):
        du, dv = image[k + 1, 0] - image[k, 0], image[k + 1, 1] - image[k, 1]
        length = math.hypot(du, dv)
        if length <= 0.2 * longest:
            continue
        reach = 0.0
        for i in range(pieces):
            gap = dv * (image[i, 0] - image[k, 0]) - du * (image[i, 1] - image[k, 1])
            reach = max(reach, abs(gap) / length)
        best = min(best, reach)
    return best if math.isfinite(best) else 0.0


@njit(cache=True, nogil=True)
def _lengths(
    image: NDArray[np.float64],
    names: NDArray[np.int64],
    pieces: int,
    scale: float,
    ends: NDArray[np.float64],
    runs: NDArray[np.float64],
) -> float:
    """Fill where each piece ends, px along the outline, and where its edge begins and ends."""
    total = begun = 0.0
    first = 0
    for k in range(pieces):
        du, dv = image[k + 1, 0] - image[k, 0], image[k + 1, 1] - image[k, 1]
        total += scale * math.hypot(du, dv)
        ends[k] = total
        if k == pieces - 1 or names[k + 1] != names[k]:
            for i in range(first, k + 1):
                runs[i, 0], runs[i, 1] = begun, total
            first, begun = k + 1, total
    return total


@njit(cache=True, nogil=True)
def places_around(
    image: NDArray[np.float64],
    names: NDArray[np.int64],
    pieces: int,
    lens: NDArray[np.float64],
    most: int,
    apart_px: float,
    places: NDArray[np.float64],
    normals: NDArray[np.float64],
    edges: NDArray[np.int64],
) -> int:
    """Fill places and unit normals outwards, (most, 2) px, evenly around; returns how many.

    `edges` (most,): which edge each is of. At least `apart_px` apart, and none near corners.
    """
    ends, runs = np.empty(pieces), np.empty((pieces, 2))
    total = _lengths(image, names, pieces, focal(lens), ends, runs)
    count = int(min(float(most), max(total / apart_px, float(PLACES_MIN))))
    made = piece = 0
    for n in range(count):
        at = (n + 0.5) * total / count
        while piece < pieces - 1 and at > ends[piece]:
            piece += 1
        if min(at - runs[piece, 0], runs[piece, 1] - at) < CORNER_PX:
            continue
        before = ends[piece - 1] if piece else 0.0
        length = max(ends[piece] - before, 1e-9)
        du, dv = image[piece + 1, 0] - image[piece, 0], image[piece + 1, 1] - image[piece, 1]
        part = (at - before) / length
        u, v = image[piece, 0] + du * part, image[piece, 1] + dv * part
        x, y = to_pixel(lens, u, v)
        ahead_x, ahead_y = to_pixel(lens, u + du / length, v + dv / length)
        norm = max(math.hypot(ahead_x - x, ahead_y - y), 1e-12)
        places[made, 0], places[made, 1] = x, y
        normals[made, 0], normals[made, 1] = (ahead_y - y) / norm, (x - ahead_x) / norm
        edges[made] = names[piece]
        made += 1
    return made


@njit(cache=True, nogil=True)
def lonely_share(
    places: NDArray[np.float64],
    count: int,
    points: NDArray[np.float64],
    lens: NDArray[np.float64],
    grain: float,
) -> float:
    """Share of the places inside the picture without a point (n, 2) px within two grains."""
    border, reach = 2.0 * grain, 2.0 * grain + 1.0
    inside = lonely = 0
    for i in range(count):
        x, y = places[i, 0], places[i, 1]
        if not (border < x < lens[WIDTH] - border and border < y < lens[HEIGHT] - border):
            continue
        inside += 1
        found = False
        for k in range(points.shape[0]):
            dx, dy = points[k, 0] - x, points[k, 1] - y
            if dx * dx + dy * dy < reach * reach:
                found = True
                break
        lonely += not found
    return lonely / inside if inside else 1.0


@njit(cache=True, nogil=True)
def visible_area(image: NDArray[np.float64], pieces: int, lens: NDArray[np.float64]) -> float:
    """Pixels of the picture that an outline covers."""
    polygon, other = np.empty((2 * VERTICES, 2)), np.empty((2 * VERTICES, 2))
    for k in range(pieces):
        polygon[k, 0], polygon[k, 1] = to_pixel(lens, image[k, 0], image[k, 1])
    count = pieces
    for side in range(4):
        axis, sign = side % 2, 1.0 if side < 2 else -1.0
        limit = -0.5 if side < 2 else 0.5 - lens[WIDTH + axis]
        kept = 0
        for k in range(count):
            a, b = polygon[k], polygon[(k + 1) % count]
            here, there = sign * a[axis] - limit, sign * b[axis] - limit
            if here >= 0.0:
                other[kept] = a
                kept += 1
            if (here >= 0.0) != (there >= 0.0):
                other[kept] = a + (b - a) * (here / (here - there))
                kept += 1
        polygon, other, count = other, polygon, kept
    area = 0.0
    for k in range(count):
        a, b = polygon[k], polygon[(k + 1) % count]
        area += a[0] * b[1] - a[1] * b[0]
    return abs(area) / 2.0
