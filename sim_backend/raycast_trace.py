"""What the rays of one tile meet: one pass over the rays for each primitive. numba kernels.

Passes keep arrays out of the calls made for every ray: numba counts references at each of them,
which costs more than meeting a rectangle does.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from sim_backend.raycast_shapes import FAR, hit_box, hit_capsule, hit_cylinder, hit_sphere
from sim_backend.raycast_types import (
    BOX,
    CAPSULE,
    CASTS,
    CYLINDER,
    KIND,
    LIGHT_X,
    LIGHT_Y,
    LIGHT_Z,
    NEAR,
    RECTANGLE,
    SPHERE,
    A,
    B,
    C,
)

_NEAR_M = 1e-6
_LIFT_M = 1e-4
_MARGIN_M = 0.03


@njit(cache=True, nogil=True, error_model="numpy")
def _any_beyond(depth, limit):  # type: ignore[no-untyped-def]
    beyond = 0
    for i in range(depth.shape[0]):
        beyond += depth[i] > limit
    return beyond > 0


@njit(cache=True, nogil=True, error_model="numpy")
def trace(rays, table, items, xs, ys, depth, found):  # type: ignore[no-untyped-def]
    """Number of the primitive each ray meets first, -1 for none, and its depth in m.

    `rays` (P, 12) of one moment, `items`: the tile's primitives, nearest first; `xs`, `ys`: places
    in the picture, (n,) like `depth` and `found`.
    """
    depth[:] = FAR
    found[:] = -1
    for p in items:
        if not _any_beyond(depth, table[p, NEAR]):
            break
        kind = int(table[p, KIND])
        if kind == RECTANGLE:
            _meet_rectangle(rays[p], table[p], p, xs, ys, depth, found)
        elif kind == BOX:
            _meet_box(rays[p], table[p], p, xs, ys, depth, found)
        else:
            _meet_round(kind, rays[p], table[p], p, xs, ys, depth, found)


@njit(cache=True, nogil=True, error_model="numpy")
def _meet_rectangle(m, row, p, xs, ys, depth, found):  # type: ignore[no-untyped-def]
    a, b = row[A], row[B]
    m0, m1, m2, m3, m4, m5 = m[0], m[1], m[2], m[3], m[4], m[5]
    m6, m7, m8, m9, m10, m11 = m[6], m[7], m[8], m[9], m[10], m[11]
    for i in range(xs.shape[0]):
        x, y = xs[i], ys[i]
        t = -m11 / (m6 * x + m7 * y + m8)
        hx = m9 + t * (m0 * x + m1 * y + m2)
        hy = m10 + t * (m3 * x + m4 * y + m5)
        if (abs(hx) <= a) & (abs(hy) <= b) & (t > _NEAR_M) & (t < depth[i]):
            depth[i] = t
            found[i] = p


@njit(cache=True, nogil=True, error_model="numpy")
def _meet_box(m, row, p, xs, ys, depth, found):  # type: ignore[no-untyped-def]
    a, b, c = row[A], row[B], row[C]
    m0, m1, m2, m3, m4, m5 = m[0], m[1], m[2], m[3], m[4], m[5]
    m6, m7, m8, m9, m10, m11 = m[6], m[7], m[8], m[9], m[10], m[11]
    for i in range(xs.shape[0]):
        x, y = xs[i], ys[i]
        dx = m0 * x + m1 * y + m2
        dy = m3 * x + m4 * y + m5
        dz = m6 * x + m7 * y + m8
        t = hit_box(m9, m10, m11, dx, dy, dz, a, b, c)
        if t < depth[i]:
            depth[i] = t
            found[i] = p


@njit(cache=True, nogil=True, error_model="numpy")
def _meet_round(kind, m, row, p, xs, ys, depth, found):  # type: ignore[no-untyped-def]
    a, b = row[A], row[B]
    m0, m1, m2, m3, m4, m5 = m[0], m[1], m[2], m[3], m[4], m[5]
    m6, m7, m8, m9, m10, m11 = m[6], m[7], m[8], m[9], m[10], m[11]
    for i in range(xs.shape[0]):
        x, y = xs[i], ys[i]
        dx = m0 * x + m1 * y + m2
        dy = m3 * x + m4 * y + m5
        dz = m6 * x + m7 * y + m8
        if kind == CYLINDER:
            t = hit_cylinder(m9, m10, m11, dx, dy, dz, a, b)
        elif kind == SPHERE:
            t = hit_sphere(m9, m10, m11, dx, dy, dz, a)
        else:
            t = hit_capsule(m9, m10, m11, dx, dy, dz, a, b)
        if t < depth[i]:
            depth[i] = t
            found[i] = p


@njit(cache=True, nogil=True, error_model="numpy")
def shading(rays, table, columns, rows, items, depth, found, count):  # type: ignore[no-untyped-def]
    """Numbers of the primitives that may keep the light from what a tile's `count` rays meet."""
    trace(rays, table, items, columns[:count], rows[:count], depth[:count], found[:count])
    casters, n = np.empty(table.shape[0], dtype=np.int64), 0
    for q in range(table.shape[0]):
        if table[q, CASTS] > 0.0:
            reach = table[q, A] + table[q, B] + table[q, C] + _MARGIN_M
            if _may_cast(-1, reach, rays[q], table[q], columns, rows, depth, found[:count]):
                casters[n] = q
                n += 1
    return casters[:n]


@njit(cache=True, nogil=True, error_model="numpy")
def darken(p, casters, rays, table, xs, ys, depth, found, facing):  # type: ignore[no-untyped-def]
    """Set `facing` (n,) to 0 where one of the casters keeps the light from primitive p."""
    for q in casters:
        if q != p:
            m, row = rays[q], table[q]
            if _may_cast(p, row[A] + row[B] + row[C], m, row, xs, ys, depth, found):
                _cast(p, m, row, xs, ys, depth, found, facing)


@njit(cache=True, nogil=True, error_model="numpy")
def _may_cast(p, reach, m, row, xs, ys, depth, found):  # type: ignore[no-untyped-def]
    """Whether the light to any point of p that is seen, or of anything if p is -1, passes near."""
    m0, m1, m2, m3, m4, m5 = m[0], m[1], m[2], m[3], m[4], m[5]
    m6, m7, m8, m9, m10, m11 = m[6], m[7], m[8], m[9], m[10], m[11]
    lx, ly, lz = row[LIGHT_X], row[LIGHT_Y], row[LIGHT_Z]
    near, any_will_do = 0, p < 0
    for i in range(found.shape[0]):
        x, y, t = xs[i], ys[i], depth[i]
        ox = m9 + t * (m0 * x + m1 * y + m2)
        oy = m10 + t * (m3 * x + m4 * y + m5)
        oz = m11 + t * (m6 * x + m7 * y + m8)
        along = ox * lx + oy * ly + oz * lz
        aside = ox * ox + oy * oy + oz * oz - along * along
        near += (aside <= reach * reach) & (any_will_do | (found[i] == p))
    return near > 0


@njit(cache=True, nogil=True, error_model="numpy")
def _cast(p, m, row, xs, ys, depth, found, facing):  # type: ignore[no-untyped-def]
    lx, ly, lz = row[LIGHT_X], row[LIGHT_Y], row[LIGHT_Z]
    kind, a, b, c = int(row[KIND]), row[A], row[B], row[C]
    for i in range(xs.shape[0]):
        if found[i] != p or facing[i] <= 0.0:
            continue
        x, y, t = xs[i], ys[i], depth[i]
        ox = m[9] + t * (m[0] * x + m[1] * y + m[2]) + _LIFT_M * lx
        oy = m[10] + t * (m[3] * x + m[4] * y + m[5]) + _LIFT_M * ly
        oz = m[11] + t * (m[6] * x + m[7] * y + m[8]) + _LIFT_M * lz
        if kind == BOX:
            far = hit_box(ox, oy, oz, lx, ly, lz, a, b, c)
        elif kind == CYLINDER:
            far = hit_cylinder(ox, oy, oz, lx, ly, lz, a, b)
        elif kind == SPHERE:
            far = hit_sphere(ox, oy, oz, lx, ly, lz, a)
        elif kind == CAPSULE:
            far = hit_capsule(ox, oy, oz, lx, ly, lz, a, b)
        else:
            far = FAR
        if far < FAR:
            facing[i] = 0.0
