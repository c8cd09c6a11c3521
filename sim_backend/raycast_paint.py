"""The colours of what the rays of one tile meet. numba kernels."""

from __future__ import annotations

import math

from numba import njit

from sim_backend.raycast_shapes import surface
from sim_backend.raycast_types import (
    AMBIENT_SHARE,
    BLUE,
    BRIGHT,
    GREEN,
    KIND,
    LIGHT_X,
    LIGHT_Y,
    LIGHT_Z,
    RED,
    TEXELS_PER_M,
    TEXTURE,
    A,
    B,
    C,
    U,
    V,
)


@njit(cache=True, nogil=True, error_model="numpy")
def paint_plain(p, m, row, xs, ys, found, reds, greens, blues):  # type: ignore[no-untyped-def]
    """Light that comes back where a ray meets rectangle p, which has one colour."""
    share, bright, cosine = row[AMBIENT_SHARE], row[BRIGHT], row[LIGHT_Z]
    front = bright * (share + (1.0 - share) * max(cosine, 0.0))
    back = bright * (share + (1.0 - share) * max(-cosine, 0.0))
    r, g, b = row[RED], row[GREEN], row[BLUE]
    m6, m7, m8 = m[6], m[7], m[8]
    for i in range(xs.shape[0]):
        lit = back if m6 * xs[i] + m7 * ys[i] + m8 > 0.0 else front
        if found[i] == p:
            reds[i], greens[i], blues[i] = lit * r, lit * g, lit * b


@njit(cache=True, nogil=True, error_model="numpy")
def face(p, m, row, xs, ys, depth, found, facing, us, vs):  # type: ignore[no-untyped-def]
    """Cosine to the light, and texture place, where a ray meets primitive p, (n,) each."""
    kind, a, b, c = int(row[KIND]), row[A], row[B], row[C]
    wants_uv = row[TEXTURE] >= 0.0
    lx, ly, lz = row[LIGHT_X], row[LIGHT_Y], row[LIGHT_Z]
    m0, m1, m2, m3, m4, m5 = m[0], m[1], m[2], m[3], m[4], m[5]
    m6, m7, m8, m9, m10, m11 = m[6], m[7], m[8], m[9], m[10], m[11]
    for i in range(xs.shape[0]):
        if found[i] != p:
            continue
        x, y, t = xs[i], ys[i], depth[i]
        dz = m6 * x + m7 * y + m8
        hx = m9 + t * (m0 * x + m1 * y + m2)
        hy = m10 + t * (m3 * x + m4 * y + m5)
        nx, ny, nz, u, v = surface(kind, hx, hy, m11 + t * dz, a, b, c, wants_uv)
        cosine = nx * lx + ny * ly + nz * lz
        facing[i] = cosine
        us[i], vs[i] = u, v


@njit(cache=True, nogil=True, error_model="numpy")
def paint(p, row, found, facing, reds, greens, blues):  # type: ignore[no-untyped-def]
    """Light that comes back where a ray meets primitive p, as far as it has one colour."""
    r, g, b = row[RED], row[GREEN], row[BLUE]
    share, bright = row[AMBIENT_SHARE], row[BRIGHT]
    for i in range(found.shape[0]):
        lit = bright * (share + (1.0 - share) * max(facing[i], 0.0))
        if found[i] == p:
            reds[i], greens[i], blues[i] = lit * r, lit * g, lit * b


@njit(cache=True, nogil=True, error_model="numpy")
def _wrapped(place, size):  # type: ignore[no-untyped-def]
    index = math.floor(place)
    return index % size if index < 0 or index >= size else index


@njit(cache=True, nogil=True, error_model="numpy")
def paper(  # type: ignore[no-untyped-def]
    p, row, texels, pyramid, levels, texel_size, place, depth, found, facing, us, vs, reds, greens,
    blues,
):  # fmt: skip
    """Light that comes back where a ray meets primitive p, which has a texture.

    `pyramid`: first level and number of levels; `texel_size`: metres across a pixel at 1 m;
    `place`: the sample's in the pixel. It also moves the sample in the texel, so that the mean of
    many is interpolated. Where there is no texture, u is below 0 and the colour stays.
    """
    share, bright, repeat_u, repeat_v = row[AMBIENT_SHARE], row[BRIGHT], row[U], row[V]
    first, last = pyramid[0], pyramid[0] + pyramid[1] - 1
    per_m, across, down = texel_size * row[TEXELS_PER_M], place[0], place[1]
    for i in range(found.shape[0]):
        if found[i] != p or us[i] < 0.0:
            continue
        footprint, level = depth[i] * per_m, first
        while footprint > 1.0 and level < last:
            footprint *= 0.5
            level += 1
        w, h = levels[level, 1], levels[level, 2]
        column = _wrapped(us[i] * repeat_u * w + across, w)
        line = _wrapped(vs[i] * repeat_v * h + down, h)
        n = levels[level, 0] + line * w + column
        lit = bright * (share + (1.0 - share) * max(facing[i], 0.0))
        reds[i], greens[i], blues[i] = lit * texels[n, 0], lit * texels[n, 1], lit * texels[n, 2]


@njit(cache=True, nogil=True, error_model="numpy")
def face_rectangle(p, m, row, xs, ys, depth, found, facing, us, vs):  # type: ignore[no-untyped-def]
    """What `face` finds, for a rectangle."""
    m0, m1, m2, m3, m4, m5 = m[0], m[1], m[2], m[3], m[4], m[5]
    m6, m7, m8, m9, m10 = m[6], m[7], m[8], m[9], m[10]
    light, wide, high = row[LIGHT_Z], 0.5 / row[A], 0.5 / row[B]
    for i in range(xs.shape[0]):
        x, y, t = xs[i], ys[i], depth[i]
        u = 0.5 + wide * (m9 + t * (m0 * x + m1 * y + m2))
        v = 0.5 - high * (m10 + t * (m3 * x + m4 * y + m5))
        cosine = -light if m6 * x + m7 * y + m8 > 0.0 else light
        if found[i] == p:
            facing[i], us[i], vs[i] = cosine, u, v


@njit(cache=True, nogil=True, error_model="numpy")
def is_seen(p, found):  # type: ignore[no-untyped-def]
    """Whether any ray meets primitive p."""
    count = 0
    for i in range(found.shape[0]):
        count += found[i] == p
    return count > 0
