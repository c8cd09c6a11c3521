"""Colours along a line across an edge, and those of its two sides."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.geometry.linear import solve_symmetric

NOISE_LEVELS = 3.0
"""Standard deviation of one channel of one pixel, 8-bit levels."""

SHADING = 0.15
"""Relative standard deviation of brightness over a plateau inside."""

SHADING_ELSEWHERE = 0.35
"""The same between places of one object."""

LIKE = 5.0
"""Standard deviations up to which two colours may be the same."""

MORE_LIKE = 0.35
"""A colour this many times nearer to the object's than the one beside it is the object's too."""

MIXTURE = 0.2
"""How far from a straight line mixtures of two colours may lie, of its length: levels are a curve
of light."""

BEND = 0.25
"""Further aside lies no mixture, but a third thing between the two: blur may leave nothing of it
that is one colour."""

STILL_RISING = 1.04
"""A step goes on while the distance from the inner colour grows by such a factor."""


@njit(cache=True, nogil=True)
def _between(
    yuyv: NDArray[np.uint8],
    rows: tuple[int, int],
    columns: tuple[int, int],
    channel: int,
    down: float,
    right: float,
) -> float:
    """Bilinear between two rows and two columns."""
    i, below = rows
    j, beside = columns
    # differences of levels are whole numbers, which become real ones once
    first, third = np.int64(yuyv[i, j, channel]), np.int64(yuyv[below, j, channel])
    upper = first + right * (np.int64(yuyv[i, beside, channel]) - first)
    lower = third + right * (np.int64(yuyv[below, beside, channel]) - third)
    return upper + down * (lower - upper)


@njit(cache=True, nogil=True)
def colour_at(
    yuyv: NDArray[np.uint8], x: float, y: float, colours: NDArray[np.float64], k: int
) -> None:
    """Bilinear Y, U, V at a place into row k; the pairs' chroma lies between their pixels."""
    height, width = yuyv.shape[0], yuyv.shape[1]
    y, x = min(max(y, 0.0), height - 1.0), min(max(x, 0.0), width - 1.0)
    i, j = min(int(y), max(height - 2, 0)), min(int(x), max(width - 2, 0))
    pair = min(max(0.5 * (x - 0.5), 0.0), width // 2 - 1.0)
    n = min(int(pair), max(width // 2 - 2, 0))
    rows = i, min(i + 1, height - 1)
    colours[k, 0] = _between(yuyv, rows, (j, min(j + 1, width - 1)), 0, y - i, x - j)
    u, v = 2 * n, 2 * min(n + 1, width // 2 - 1)
    colours[k, 1] = _between(yuyv, rows, (u, v), 1, y - i, pair - n)
    colours[k, 2] = _between(yuyv, rows, (u + 1, v + 1), 1, y - i, pair - n)


@njit(cache=True, nogil=True)
def _is_within(yuyv: NDArray[np.uint8], x: float, y: float) -> bool:
    """Whether a place has pixels, and pairs of them, on all sides."""
    height, width = yuyv.shape[0], yuyv.shape[1]
    return 1.0 <= x < width - 2.0 and 0.0 <= y < height - 1.0


@njit(cache=True, nogil=True)
def _colour_within(
    yuyv: NDArray[np.uint8], x: float, y: float, colours: NDArray[np.float64], k: int
) -> None:
    """As `colour_at`, of a place that `_is_within`: most are, and take a third less time."""
    i, j, pair = int(y), int(x), 0.5 * (x - 0.5)
    n = int(pair)
    u = 2 * n
    colours[k, 0] = _between(yuyv, (i, i + 1), (j, j + 1), 0, y - i, x - j)
    colours[k, 1] = _between(yuyv, (i, i + 1), (u, u + 2), 1, y - i, pair - n)
    colours[k, 2] = _between(yuyv, (i, i + 1), (u + 1, u + 3), 1, y - i, pair - n)


@njit(cache=True, nogil=True)
def profile(
    yuyv: NDArray[np.uint8],
    place: NDArray[np.float64],
    normal: NDArray[np.float64],
    reach: float,
    step: float,
    depth: float,
    colours: NDArray[np.float64],
) -> int:
    """Colours from `reach` inside to `reach` outside; no deeper inside than `depth`."""
    half = int(reach / step)
    x, y, nx, ny = place[0], place[1], normal[0], normal[1]
    begin, end = max(-half * step, -depth), half * step
    within = _is_within(yuyv, x + begin * nx, y + begin * ny)
    within &= _is_within(yuyv, x + end * nx, y + end * ny)
    for k in range(2 * half + 1):
        s = max((k - half) * step, -depth)
        if within:
            _colour_within(yuyv, x + s * nx, y + s * ny, colours, k)
        else:
            colour_at(yuyv, x + s * nx, y + s * ny, colours, k)
    return 2 * half + 1


@njit(cache=True, nogil=True)
def _giving(reference: NDArray[np.float64], shading: float) -> float:
    """How much a colour's differences along its brightness are made up for, for `_distance2`."""
    u, v = reference[1] - 128.0, reference[2] - 128.0
    bright = reference[0] * reference[0] + u * u + v * v
    return 1.0 / (NOISE_LEVELS**2 / shading**2 + bright)


@njit(cache=True, nogil=True)
def _distance2(colour: NDArray[np.float64], reference: NDArray[np.float64], giving: float) -> float:
    """Squared, in standard deviations of noise and of the reference's brightness."""
    y, u, v = colour[0] - reference[0], colour[1] - reference[1], colour[2] - reference[2]
    along = y * reference[0] + u * (reference[1] - 128.0) + v * (reference[2] - 128.0)
    return (y * y + u * u + v * v - along * along * giving) * (1.0 / NOISE_LEVELS**2)


@njit(cache=True, nogil=True)
def is_of(
    inner: NDArray[np.float64], outer: NDArray[np.float64], palette: NDArray[np.float64]
) -> bool:
    """Whether the inner side of an edge has one of an object's colours (n, 3), or nearly.

    What covers an edge of the object ends in an edge of its own.
    """
    own = beside = np.inf
    for k in range(palette.shape[0]):
        giving = _giving(palette[k], SHADING_ELSEWHERE)
        own = min(own, _distance2(inner, palette[k], giving))
        if own < LIKE**2:
            return True
        beside = min(beside, _distance2(outer, palette[k], giving))
    return palette.shape[0] == 0 or own < MORE_LIKE**2 * beside


@njit(cache=True, nogil=True)
def is_between(
    colour: NDArray[np.float64], inner: NDArray[np.float64], outer: NDArray[np.float64]
) -> bool:
    """Whether a colour can be a mixture of two: near the line between them."""
    along = span2 = gap2 = 0.0
    for c in range(3):
        along += (colour[c] - inner[c]) * (outer[c] - inner[c])
        span2 += (outer[c] - inner[c]) ** 2
        gap2 += (colour[c] - inner[c]) ** 2
    if span2 < 1.0 or along < 0.0:
        return False
    aside2 = gap2 - along * along / span2
    return along < (1.0 + MIXTURE) * span2 and aside2 < max(
        (LIKE * NOISE_LEVELS) ** 2, MIXTURE**2 * span2
    )


@njit(cache=True, nogil=True)
def _bend(colours: NDArray[np.float64], first: int, last: int, inner: NDArray[np.float64]) -> int:
    """Which sample lies so far off the way from the inner colour to the last that it is no mixture.

    -1 if none does.
    """
    span2, most2, at = 0.0, (LIKE * NOISE_LEVELS) ** 2, -1
    for c in range(3):
        span2 += (colours[last, c] - inner[c]) ** 2
    if span2 < 1.0:
        return -1
    most2 = max(most2, BEND**2 * span2)
    for k in range(first, last):
        along = gap2 = 0.0
        for c in range(3):
            along += (colours[k, c] - inner[c]) * (colours[last, c] - inner[c])
            gap2 += (colours[k, c] - inner[c]) ** 2
        aside2 = gap2 - along * along / span2
        if aside2 > most2:
            most2, at = aside2, k
    return at


@njit(cache=True, nogil=True)
def outer_side(
    colours: NDArray[np.float64], count: int, few: int, inner: NDArray[np.float64]
) -> int:
    """First of `few` samples on the outer side of the first step away from the inner colour.

    Further out there may be other things still. `count` where there is no step.
    """
    total = best = 0.0
    first, giving = count, _giving(inner, SHADING)
    for k in range(count):
        distance2 = _distance2(colours[k], inner, giving)
        total += LIKE - math.sqrt(min(distance2, (2.0 * LIKE) ** 2))
        if total >= best:
            best, first = total, k + 1
    if first + few > count:
        return count
    top, at = _distance2(colours[first], inner, giving), first
    for k in range(first + 1, count - few + 1):
        distance2 = _distance2(colours[k], inner, giving)
        if distance2 > STILL_RISING**2 * top:
            # chroma is shared by pairs and follows brightness late: near the step itself any bends
            bend = _bend(colours, first + few // 2 + 1, k, inner)
            if bend >= 0:
                return bend
            top, at = distance2, k
        elif k - at > 1:
            break
    return at


@njit(cache=True, nogil=True)
def plateau(
    colours: NDArray[np.float64],
    first: int,
    last: int,
    mean: NDArray[np.float64],
    scatter: NDArray[np.float64],
) -> None:
    """Mean of rows first to last - 1, and half their covariance added to `scatter`."""
    share = 1.0 / (last - first)
    for c in range(3):
        total = 0.0
        for k in range(first, last):
            total += colours[k, c]
        mean[c] = total * share
    for c in range(3):
        for d in range(c + 1):
            total = 0.0
            for k in range(first, last):
                total += (colours[k, c] - mean[c]) * (colours[k, d] - mean[d])
            scatter[c, d] += 0.5 * share * total


@njit(cache=True, nogil=True)
def contrast_of(
    inner: NDArray[np.float64],
    outer: NDArray[np.float64],
    scatter: NDArray[np.float64],
    direction: NDArray[np.float64],
) -> float:
    """Contrast of two plateaus along the direction that tells them apart best.

    `direction` is scaled so that it takes the inner plateau to the outer one in a step of 1.
    `scatter` (3, 3), lower half, is theirs, and is used up.
    """
    for c in range(3):
        direction[c] = outer[c] - inner[c]
        scatter[c, c] += NOISE_LEVELS**2
        for d in range(c + 1):
            shade_c = inner[c] - (128.0 if c else 0.0)
            scatter[c, d] += SHADING**2 * shade_c * (inner[d] - (128.0 if d else 0.0))
    solve_symmetric(scatter, direction, direction)
    contrast2 = 0.0
    for c in range(3):
        contrast2 += direction[c] * (outer[c] - inner[c])
    if contrast2 < 1e-6:
        return 0.0
    for c in range(3):
        direction[c] /= contrast2
    return math.sqrt(contrast2)
