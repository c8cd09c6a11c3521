"""From primitives and camera poses to rays in each primitive's frame and lists for each tile."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from sim_backend.raycast_types import BOX, CAPSULE, CYLINDER, KIND, NEAR, RECTANGLE, TILE, A, B, C

_CLIP_M = 0.02
"""Nothing nearer to the camera than this is seen."""


@njit(cache=True, nogil=True, error_model="numpy")
def _extents(kind, a, b, c):  # type: ignore[no-untyped-def]
    """Half lengths of the box around a primitive."""
    if kind == RECTANGLE:
        return a, b, 0.0
    if kind == BOX:
        return a, b, c
    if kind == CYLINDER:
        return a, a, b
    if kind == CAPSULE:
        return a, a, a + b
    return a, a, a


@njit(cache=True, nogil=True, error_model="numpy")
def _corners(T, row, out):  # type: ignore[no-untyped-def]
    """The eight corners of the box around a primitive, in the camera's frame."""
    a, b, c = _extents(int(row[KIND]), row[A], row[B], row[C])
    for corner in range(8):
        x = a if corner & 1 else -a
        y = b if corner & 2 else -b
        z = c if corner & 4 else -c
        for i in range(3):
            out[corner, i] = T[i, 0] * x + T[i, 1] * y + T[i, 2] * z + T[i, 3]


@njit(cache=True, nogil=True, error_model="numpy")
def _widen(bounds, x, y, z, lens):  # type: ignore[no-untyped-def]
    u, v = lens[0] * x / z + lens[2], lens[1] * y / z + lens[3]
    bounds[0], bounds[1] = min(bounds[0], u), max(bounds[1], u)
    bounds[2], bounds[3] = min(bounds[2], v), max(bounds[3], v)


@njit(cache=True, nogil=True, error_model="numpy")
def _outline(corners, lens, bounds):  # type: ignore[no-untyped-def]
    """Widen (left, right, top, bottom) by the part of a box before the camera; least depth."""
    nearest = math.inf
    for corner in range(8):
        z = corners[corner, 2]
        nearest = min(nearest, z)
        if z > _CLIP_M:
            _widen(bounds, corners[corner, 0], corners[corner, 1], z, lens)
        for bit in (1, 2, 4):
            other = corner ^ bit
            w = corners[other, 2]
            if other > corner and (z > _CLIP_M) != (w > _CLIP_M):
                s = (_CLIP_M - z) / (w - z)
                x = corners[corner, 0] + s * (corners[other, 0] - corners[corner, 0])
                y = corners[corner, 1] + s * (corners[other, 1] - corners[corner, 1])
                _widen(bounds, x, y, _CLIP_M, lens)
    return nearest


@njit(cache=True, nogil=True, error_model="numpy")
def _ray(T, lens, out):  # type: ignore[no-untyped-def]
    """Ray of pixel (x, y) in the primitive's frame, from T_camera_primitive."""
    for i in range(3):
        out[3 * i] = T[0, i] / lens[0]
        out[3 * i + 1] = T[1, i] / lens[1]
        out[3 * i + 2] = T[2, i] - T[0, i] * lens[2] / lens[0] - T[1, i] * lens[3] / lens[1]
        out[9 + i] = -(T[0, i] * T[0, 3] + T[1, i] * T[1, 3] + T[2, i] * T[2, 3])


@njit(cache=True, nogil=True, error_model="numpy")
def project(T_camera, table, lens, rays, bounds):  # type: ignore[no-untyped-def]
    """Rays, picture bounds (left, right, top, bottom in px) and least depth of every primitive.

    `T_camera` (K, P, 4, 4): T_camera_primitive at K moments; `lens`: fx, fy, cx, cy. The depth
    goes into the table's column.
    """
    corners = np.empty((8, 3))
    for p in range(table.shape[0]):
        bounds[p, 0] = bounds[p, 2] = math.inf
        bounds[p, 1] = bounds[p, 3] = -math.inf
        table[p, NEAR] = math.inf
        for k in range(T_camera.shape[0]):
            T = T_camera[k, p]
            _ray(T, lens, rays[k, p])
            _corners(T, table[p], corners)
            table[p, NEAR] = min(table[p, NEAR], _outline(corners, lens, bounds[p]))


@njit(cache=True, nogil=True, error_model="numpy")
def _tile_range(low, high, size):  # type: ignore[no-untyped-def]
    """First and last-but-one tile touched by pixels from low to high, one pixel of margin."""
    first = max(0.0, np.floor((low - 1.0) / TILE))
    last = min(np.floor((high + 1.0) / TILE), np.floor((size - 1) / TILE))
    if not (first <= last):
        return 0, 0
    return int(first), int(last) + 1


@njit(cache=True, nogil=True, error_model="numpy")
def list_tiles(bounds, order, width, height):  # type: ignore[no-untyped-def]
    """Primitives of every tile in the given order: their numbers, and where each tile's begin."""
    columns, rows = (width + TILE - 1) // TILE, (height + TILE - 1) // TILE
    starts = np.zeros(columns * rows + 1, dtype=np.int64)
    for filling in range(2):
        if filling:
            for n in range(columns * rows):
                starts[n + 1] += starts[n]
            items = np.empty(starts[-1], dtype=np.int64)
            ends = starts.copy()
        for p in order:
            c0, c1 = _tile_range(bounds[p, 0], bounds[p, 1], width)
            r0, r1 = _tile_range(bounds[p, 2], bounds[p, 3], height)
            for row in range(r0, r1):
                for column in range(c0, c1):
                    n = row * columns + column
                    if filling:
                        items[ends[n]] = p
                        ends[n] += 1
                    else:
                        starts[n + 1] += 1
    return items, starts
