"""The ray caster: anti-aliased, motion-blurred pictures of primitives. numba kernels.

Every sample of a pixel has its own place in the pixel and its own moment of the exposure; the mean
is taken in linear light. A pixel whose first four samples agree is done; else all sixteen are cast.
"""

from __future__ import annotations

import math

from numba import njit

from sim_backend.raycast_shapes import FAR, RECTANGLE, hit, surface
from sim_backend.raycast_types import (
    AMBIENT_SHARE,
    BLUE,
    BRIGHT,
    CASTS,
    GREEN,
    KIND,
    LIGHT_X,
    LIGHT_Y,
    LIGHT_Z,
    NEAR,
    PARTS,
    PLACES,
    RED,
    SAMPLES,
    TEXELS_PER_M,
    TEXTURE,
    TILE,
    A,
    B,
    C,
    U,
    V,
)

FIRST = 4
_SPREAD_ABSOLUTE, _SPREAD_RELATIVE = 0.004, 0.04
_LIFT_M = 1e-4


@njit(cache=True, nogil=True)
def _nearest(rays, table, items, k, x, y, first, last):  # type: ignore[no-untyped-def]
    """Which of a tile's primitives the ray meets first, and at what depth; -1 if none."""
    best, found = FAR, -1
    for n in range(first, last):
        p = items[n]
        if table[p, NEAR] > best:
            break
        dx = rays[k, p, 0] * x + rays[k, p, 1] * y + rays[k, p, 2]
        dy = rays[k, p, 3] * x + rays[k, p, 4] * y + rays[k, p, 5]
        dz = rays[k, p, 6] * x + rays[k, p, 7] * y + rays[k, p, 8]
        t = hit(
            int(table[p, KIND]), rays[k, p, 9], rays[k, p, 10], rays[k, p, 11], dx, dy, dz,
            table[p, A], table[p, B], table[p, C],
        )  # fmt: skip
        if t < best:
            best, found = t, p
    return found, best


@njit(cache=True, nogil=True)
def _texel(levels, level, top, u, v, footprint, place_x, place_y):  # type: ignore[no-untyped-def]
    """Number of the texel at (u, v), in the level of the pyramid that fits a pixel's footprint."""
    while footprint > 1.0 and top > 0:
        footprint *= 0.5
        level += 1
        top -= 1
    w, h = levels[level, 1], levels[level, 2]
    # the sample's place in the pixel also moves it in the texel: the mean is interpolated
    column = math.floor(u * w + place_x) % w
    row = math.floor(v * h + place_y) % h
    return levels[level, 0] + row * w + column


@njit(cache=True, nogil=True)
def _in_shadow(rays, table, k, x, y, t, own):  # type: ignore[no-untyped-def]
    """Whether something stands between a point of the ray and the light."""
    for q in range(table.shape[0]):
        if q == own or table[q, CASTS] == 0.0:
            continue
        lx, ly, lz = table[q, LIGHT_X], table[q, LIGHT_Y], table[q, LIGHT_Z]
        ox = rays[k, q, 9] + t * (rays[k, q, 0] * x + rays[k, q, 1] * y + rays[k, q, 2])
        oy = rays[k, q, 10] + t * (rays[k, q, 3] * x + rays[k, q, 4] * y + rays[k, q, 5])
        oz = rays[k, q, 11] + t * (rays[k, q, 6] * x + rays[k, q, 7] * y + rays[k, q, 8])
        ox, oy, oz = ox + _LIFT_M * lx, oy + _LIFT_M * ly, oz + _LIFT_M * lz
        a, b, c = table[q, A], table[q, B], table[q, C]
        along = ox * lx + oy * ly + oz * lz
        reach = a + b + c
        if ox * ox + oy * oy + oz * oz - along * along > reach * reach:
            continue
        if hit(int(table[q, KIND]), ox, oy, oz, lx, ly, lz, a, b, c) < FAR:
            return True
    return False


@njit(cache=True, nogil=True)
def _facing(rays, table, k, x, y, t, p, shadows):  # type: ignore[no-untyped-def]
    """Cosine to the light where the ray meets primitive p, 0 in shadow, and the texture place."""
    dz = rays[k, p, 6] * x + rays[k, p, 7] * y + rays[k, p, 8]
    hx = rays[k, p, 9] + t * (rays[k, p, 0] * x + rays[k, p, 1] * y + rays[k, p, 2])
    hy = rays[k, p, 10] + t * (rays[k, p, 3] * x + rays[k, p, 4] * y + rays[k, p, 5])
    kind = int(table[p, KIND])
    nx, ny, nz, u, v = surface(
        kind, hx, hy, rays[k, p, 11] + t * dz, table[p, A], table[p, B], table[p, C],
        table[p, TEXTURE] >= 0.0,
    )  # fmt: skip
    facing = nx * table[p, LIGHT_X] + ny * table[p, LIGHT_Y] + nz * table[p, LIGHT_Z]
    if kind == RECTANGLE and dz > 0.0:
        facing = -facing
    if facing < 0.0 or (shadows and _in_shadow(rays, table, k, x, y, t, p)):
        facing = 0.0
    return facing, u, v


@njit(cache=True, nogil=True)
def _pixel(  # type: ignore[no-untyped-def]
    rays, table, items, texels, pyramids, levels, i, j, first, last, texel_size, least, shadows, out
):
    """Mean colour of pixel (row i, column j) into `out[i, j]`."""
    moments = rays.shape[0]
    red, green, blue = 0.0, 0.0, 0.0
    low, high = FAR, -FAR
    same, owner, count = True, -2, 0
    for sample in range(SAMPLES):
        if sample == least and same and high - low <= _SPREAD_ABSOLUTE + _SPREAD_RELATIVE * high:
            break
        k = PARTS[sample] * moments // SAMPLES
        px, py = PLACES[sample, 0], PLACES[sample, 1]
        x, y = j + px, i + py
        p, t = _nearest(rays, table, items, k, x, y, first, last)
        count += 1
        same = same and (owner in (-2, p))
        owner = p
        if p < 0:
            continue
        facing, u, v = _facing(rays, table, k, x, y, t, p, shadows)
        share = table[p, AMBIENT_SHARE]
        lit = table[p, BRIGHT] * (share + (1.0 - share) * facing)
        r, g, b = table[p, RED], table[p, GREEN], table[p, BLUE]
        texture = int(table[p, TEXTURE])
        if texture >= 0 and u >= 0.0:
            n = _texel(
                levels, pyramids[texture, 0], pyramids[texture, 1] - 1, u * table[p, U],
                v * table[p, V], t * texel_size * table[p, TEXELS_PER_M], px, py,
            )  # fmt: skip
            r, g, b = float(texels[n, 0]), float(texels[n, 1]), float(texels[n, 2])
        red, green, blue = red + lit * r, green + lit * g, blue + lit * b
        grey = lit * (r + g + b)
        low, high = min(low, grey), max(high, grey)
    out[i, j, 0], out[i, j, 1], out[i, j, 2] = red / count, green / count, blue / count


@njit(cache=True, nogil=True)
def _is_flat(rays, table, items, first, last, i0, i1, j0, j1):  # type: ignore[no-untyped-def]
    """Whether one untextured rectangle fills the tile through the whole exposure."""
    if last - first != 1:
        return False
    p = items[first]
    if table[p, KIND] != RECTANGLE or table[p, TEXTURE] >= 0.0:
        return False
    for k in range(rays.shape[0]):
        for y in (i0 - 1.0, float(i1)):
            for x in (j0 - 1.0, float(j1)):
                found, _ = _nearest(rays, table, items, k, x, y, first, last)
                if found < 0:
                    return False
    return True


@njit(cache=True, nogil=True)
def render(rays, table, items, starts, texels, pyramids, levels, texel_size, least, shadows, out):  # type: ignore[no-untyped-def]
    """Picture into `out` (height, width, 3) float32, linear light, 1 is full.

    `least`: samples of a pixel before it may be left, `FIRST` or `SAMPLES`; `texel_size`: metres
    across a pixel at a depth of 1 m.
    """
    height, width = out.shape[0], out.shape[1]
    columns = (width + TILE - 1) // TILE
    for n in range(starts.shape[0] - 1):
        i0, j0 = n // columns * TILE, n % columns * TILE
        i1, j1 = min(i0 + TILE, height), min(j0 + TILE, width)
        first, last = starts[n], starts[n + 1]
        flat = not shadows and _is_flat(rays, table, items, first, last, i0, i1, j0, j1)
        for i in range(i0, i1):
            for j in range(j0, j1):
                if flat and (i > i0 or j > j0):
                    for channel in range(3):
                        out[i, j, channel] = out[i0, j0, channel]
                    continue
                _pixel(
                    rays, table, items, texels, pyramids, levels, i, j, first, last, texel_size,
                    least, shadows, out,
                )  # fmt: skip


@njit(cache=True, nogil=True)
def count_hits(rays, table, items, starts, wanted, out):  # type: ignore[no-untyped-def]
    """How many of each pixel's samples meet a wanted primitive, into `out` (height, width) uint8.

    `wanted` (P,) bool.
    """
    height, width = out.shape
    columns = (width + TILE - 1) // TILE
    moments = rays.shape[0]
    for i in range(height):
        for j in range(width):
            n = i // TILE * columns + j // TILE
            hits = 0
            for sample in range(SAMPLES):
                k = PARTS[sample] * moments // SAMPLES
                x, y = j + PLACES[sample, 0], i + PLACES[sample, 1]
                p, _ = _nearest(rays, table, items, k, x, y, starts[n], starts[n + 1])
                if p >= 0 and wanted[p]:
                    hits += 1
            out[i, j] = hits
