"""The ray caster: anti-aliased, motion-blurred pictures of primitives. numba kernels.

Every sample of a pixel has its own place in the pixel and its own moment of the exposure; the mean
is taken in linear light. A pixel whose first four samples agree is done; else all sixteen are cast.
Work goes tile by tile and, in a tile, sample by sample over all pixels that still want more.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from sim_backend.raycast_paint import face, face_rectangle, is_seen, paint, paint_plain, paper
from sim_backend.raycast_trace import darken, shading, trace
from sim_backend.raycast_types import KIND, PARTS, PLACES, RECTANGLE, SAMPLES, TEXTURE, TILE, A, B

FIRST = 4
_SPREAD_ABSOLUTE, _SPREAD_RELATIVE = 0.006, 0.12
_ROWS = 16
# rows of a tile's work sheet; what belongs to a pixel as long as it wants more samples comes last
_X, _Y, _DEPTH, _FACING, _U, _V, _R, _G, _B = range(9)
_SUM_R, _SUM_G, _SUM_B, _LOW, _HIGH, _ROW, _COLUMN = range(9, 16)


@njit(cache=True, nogil=True, error_model="numpy")
def _spread_out(i0, i1, j0, j1, width, pixels, sheet):  # type: ignore[no-untyped-def]
    """Number the tile's pixels, with nothing summed yet; how many there are."""
    n = 0
    for i in range(i0, i1):
        for j in range(j0, j1):
            pixels[n] = i * width + j
            sheet[_ROW, n], sheet[_COLUMN, n] = i, j
            n += 1
    sheet[_SUM_R : _SUM_B + 1, :] = 0.0
    sheet[_LOW, :], sheet[_HIGH, :] = np.inf, -np.inf
    return n


@njit(cache=True, nogil=True, error_model="numpy")
def _colour(  # type: ignore[no-untyped-def]
    p, rays, table, texels, pyramids, levels, texel_size, place, casters, sheet, found
):
    """Light that comes back where a ray meets primitive p."""
    xs, ys, depth, facing = sheet[_X], sheet[_Y], sheet[_DEPTH], sheet[_FACING]
    us, vs, reds, greens, blues = sheet[_U], sheet[_V], sheet[_R], sheet[_G], sheet[_B]
    m, row = rays[p], table[p]
    texture, is_rectangle = int(row[TEXTURE]), row[KIND] == RECTANGLE
    dark = casters.shape[0] > 0
    if texture < 0 and is_rectangle and not dark:
        paint_plain(p, m, row, xs, ys, found, reds, greens, blues)
        return
    if is_rectangle:
        face_rectangle(p, m, row, xs, ys, depth, found, facing, us, vs)
    else:
        face(p, m, row, xs, ys, depth, found, facing, us, vs)
    if dark:
        darken(p, casters, rays, table, xs, ys, depth, found, facing)
    if texture < 0 or not is_rectangle:
        paint(p, row, found, facing, reds, greens, blues)
    if texture >= 0:
        paper(
            p, row, texels, pyramids[texture], levels, texel_size, place, depth, found, facing,
            us, vs, reds, greens, blues,
        )  # fmt: skip


@njit(cache=True, nogil=True, error_model="numpy")
def _sample(  # type: ignore[no-untyped-def]
    rays, table, items, texels, pyramids, levels, texel_size, place, casters, sheet, found
):
    """Colours of one sample of every pixel at the sheet's places."""
    trace(rays, table, items, sheet[_X], sheet[_Y], sheet[_DEPTH], found)
    sheet[_R : _B + 1, :] = 0.0
    for p in items:
        if is_seen(p, found):
            _colour(
                p, rays, table, texels, pyramids, levels, texel_size, place, casters, sheet, found
            )


@njit(cache=True, nogil=True, error_model="numpy")
def _add(first, sheet, found, owner):  # type: ignore[no-untyped-def]
    """Add a sample; `owner` keeps what all samples of a pixel met, -2 if they differ."""
    for n in range(found.shape[0]):
        r, g, b = sheet[_R, n], sheet[_G, n], sheet[_B, n]
        grey = r + g + b
        sheet[_SUM_R, n] += r
        sheet[_SUM_G, n] += g
        sheet[_SUM_B, n] += b
        sheet[_LOW, n] = min(sheet[_LOW, n], grey)
        sheet[_HIGH, n] = max(sheet[_HIGH, n], grey)
        owner[n] = found[n] if first or owner[n] == found[n] else -2


@njit(cache=True, nogil=True, error_model="numpy")
def _finish(count, samples, sheet, owner, pixels, out):  # type: ignore[no-untyped-def]
    """Write the pixels whose samples agree; keep the others at the front. How many are left.

    `samples`: how many of each have been summed.
    """
    left, rest = 0, samples < SAMPLES
    for n in range(count):
        allowed = _SPREAD_ABSOLUTE + _SPREAD_RELATIVE * sheet[_HIGH, n]
        if rest and (owner[n] == -2 or sheet[_HIGH, n] - sheet[_LOW, n] > allowed):
            pixels[left], owner[left] = pixels[n], owner[n]
            for row in range(_SUM_R, _ROWS):
                sheet[row, left] = sheet[row, n]
            left += 1
            continue
        for channel in range(3):
            out[pixels[n], channel] = sheet[_SUM_R + channel, n] / samples
    return left


@njit(cache=True, nogil=True, error_model="numpy")
def _aim(count, place, sheet):  # type: ignore[no-untyped-def]
    """Where in the picture a sample of each pixel lies."""
    across, down = place[0], place[1]
    for n in range(count):
        sheet[_X, n] = sheet[_COLUMN, n] + across
        sheet[_Y, n] = sheet[_ROW, n] + down


@njit(cache=True, nogil=True, error_model="numpy")
def _is_flat(rays, table, tile, i0, i1, j0, j1):  # type: ignore[no-untyped-def]
    """Whether one rectangle of one colour fills the tile through the whole exposure."""
    if tile.shape[0] != 1:
        return False
    p = tile[0]
    if table[p, KIND] != RECTANGLE or table[p, TEXTURE] >= 0.0:
        return False
    for k in range(rays.shape[0]):
        m = rays[k, p]
        for y in (i0 - 1.0, float(i1)):
            for x in (j0 - 1.0, float(j1)):
                t = -m[11] / (m[6] * x + m[7] * y + m[8])
                across = abs(m[9] + t * (m[0] * x + m[1] * y + m[2]))
                along = abs(m[10] + t * (m[3] * x + m[4] * y + m[5]))
                if not (t > 0.0 and across <= table[p, A] and along <= table[p, B]):
                    return False
    return True


@njit(cache=True, nogil=True, error_model="numpy")
def render(  # type: ignore[no-untyped-def]
    rays, table, items, starts, texels, pyramids, levels, texel_size, least, shadows, width, out
):
    """Picture into `out` (height * width, 3) float32, linear light, 1 is full.

    `least`: samples of a pixel before it may be left, `FIRST` or `SAMPLES`; `texel_size`: metres
    across a pixel at a depth of 1 m.
    """
    height, columns = out.shape[0] // width, (width + TILE - 1) // TILE
    sheet, pixels = np.empty((_ROWS, TILE * TILE)), np.empty(TILE * TILE, dtype=np.int64)
    found, owner = np.empty(TILE * TILE, dtype=np.int64), np.empty(TILE * TILE, dtype=np.int64)
    moments, none, depth = rays.shape[0], items[:0], sheet[_DEPTH]
    for n in range(starts.shape[0] - 1):
        i0, j0 = n // columns * TILE, n % columns * TILE
        i1, j1 = min(i0 + TILE, height), min(j0 + TILE, width)
        count = _spread_out(i0, i1, j0, j1, width, pixels, sheet)
        tile = items[starts[n] : starts[n + 1]]
        casters = none
        if shadows:
            casters = shading(
                rays[0], table, sheet[_COLUMN], sheet[_ROW], tile, depth, found, count
            )
        flat = casters.shape[0] == 0 and _is_flat(rays, table, tile, i0, i1, j0, j1)
        enough = 1 if flat else least
        for sample in range(SAMPLES):
            if count == 0:
                break
            k = PARTS[sample] * moments // SAMPLES
            _aim(count, PLACES[sample], sheet)
            _sample(
                rays[k], table, tile, texels, pyramids, levels, texel_size, PLACES[sample],
                casters, sheet[:, :count], found[:count],
            )  # fmt: skip
            _add(sample == 0, sheet, found[:count], owner)
            if sample + 1 in (enough, SAMPLES):
                count = _finish(count, sample + 1, sheet, owner, pixels, out)


@njit(cache=True, nogil=True, error_model="numpy")
def count_hits(rays, table, items, starts, wanted, width, out):  # type: ignore[no-untyped-def]
    """How many of each pixel's samples meet a wanted primitive, into `out` (height * width,).

    `wanted` (P,) bool.
    """
    height, columns = out.shape[0] // width, (width + TILE - 1) // TILE
    sheet, pixels = np.empty((_ROWS, TILE * TILE)), np.empty(TILE * TILE, dtype=np.int64)
    found = np.empty(TILE * TILE, dtype=np.int64)
    moments = rays.shape[0]
    out[:] = 0
    for n in range(starts.shape[0] - 1):
        i0, j0 = n // columns * TILE, n % columns * TILE
        i1, j1 = min(i0 + TILE, height), min(j0 + TILE, width)
        count = _spread_out(i0, i1, j0, j1, width, pixels, sheet)
        tile = items[starts[n] : starts[n + 1]]
        for sample in range(SAMPLES):
            k = PARTS[sample] * moments // SAMPLES
            _aim(count, PLACES[sample], sheet)
            part = sheet[:, :count]
            trace(rays[k], table, tile, part[_X], part[_Y], part[_DEPTH], found[:count])
            for m in range(count):
                if found[m] >= 0 and wanted[found[m]]:
                    out[pixels[m]] += 1
