"""The place of an edge from the pixels about it, each predicted as the camera makes it.

Lens, pixel and motion mix light; the level a pixel gets is a curve of the mixture; the chroma of a
pair of pixels is a mean of levels. A profile across an edge is therefore not symmetric, and the
level at the edge not half-way. So the edge is put where the predicted pairs of pixels fit the seen
ones best.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

SHARES = 17
PAIRS_MAX = 160
ALONG_PX = 1.5
"""How far along the edge pixels are taken."""

ASIDE_PX = 1.5
"""How far beyond the mixing they are taken across it."""

MIXING_MAX_PX = 24.0
SHIFT_MAX_PX = 2.0
STEPS = 6
WIDTH_MIN_PX = 0.9
WIDTH_DAMPING = 1e-3
"""Information about the width that a step counts on, per score variance and px squared: pixels on
one side of the mixing or the other say nothing of it."""


@njit(cache=True, nogil=True)
def _score(scores: NDArray[np.float64], gap: float, per_width: float) -> tuple[float, float]:
    """Predicted score of a pixel whose middle lies `gap` outside the edge, and its rise per px."""
    share = 0.5 + gap * per_width
    if share <= 0.0:
        return 0.0, 0.0
    if share >= 1.0:
        return 1.0, 0.0
    place = share * (SHARES - 1)
    k = int(place)
    rise = scores[k + 1] - scores[k]
    return scores[k] + (place - k) * rise, rise * (SHARES - 1) * per_width


@njit(cache=True, nogil=True)
def _gather(
    yuyv: NDArray[np.uint8],
    x: float,
    y: float,
    nx: float,
    ny: float,
    across: float,
    inner: NDArray[np.float64],
    direction: NDArray[np.float64],
    pairs: NDArray[np.float64],
) -> int:
    """Pairs of pixels about (x, y): how far outside each pixel lies, and the score seen."""
    height, half = yuyv.shape[0], yuyv.shape[1] // 2
    zero = direction[0] * inner[0] + direction[1] * inner[1] + direction[2] * inner[2]
    reach_x = across * abs(nx) + ALONG_PX * abs(ny) + 1.0
    reach_y = across * abs(ny) + ALONG_PX * abs(nx)
    count = 0
    for i in range(max(math.ceil(y - reach_y), 0), min(int(y + reach_y) + 1, height)):
        first = max(math.ceil((x - 0.5 - reach_x) / 2.0), 0)
        for pair in range(first, min(int((x - 0.5 + reach_x) / 2.0) + 1, half)):
            dx, dy = 2.0 * pair + 0.5 - x, i - y
            if abs(dx * nx + dy * ny) > across or abs(dy * nx - dx * ny) > ALONG_PX + abs(ny):
                continue
            if count == pairs.shape[0]:
                return count
            j = 2 * pair
            luma = 0.5 * (yuyv[i, j, 0] + float(yuyv[i, j + 1, 0]))
            pairs[count, 0] = (dx - 0.5) * nx + dy * ny
            pairs[count, 1] = (dx + 0.5) * nx + dy * ny
            pairs[count, 2] = (
                direction[0] * luma
                + direction[1] * yuyv[i, j, 1]
                + direction[2] * yuyv[i, j + 1, 1]
                - zero
            )
            count += 1
    return count


@njit(cache=True, nogil=True)
def _improve(
    scores: NDArray[np.float64],
    pairs: NDArray[np.float64],
    count: int,
    shift: float,
    width: float,
    seeming: float,
    prior: float,
) -> tuple[float, float, float, float]:
    """Gauss-Newton step of shift and of width, and the information of both."""
    a11 = a12 = b1 = 0.0
    per_width = 1.0 / width
    a22, b2 = WIDTH_DAMPING + prior, prior * (seeming - width)
    for k in range(count):
        pair = pairs[k]
        a, b = pair[0] - shift, pair[1] - shift
        first, first_rise = _score(scores, a, per_width)
        second, second_rise = _score(scores, b, per_width)
        gap = pair[2] - 0.5 * (first + second)
        by_shift = -0.5 * (first_rise + second_rise)
        by_width = -0.5 * (first_rise * a + second_rise * b) * per_width
        a11 += by_shift * by_shift
        a12 += by_shift * by_width
        a22 += by_width * by_width
        b1 += by_shift * gap
        b2 += by_width * gap
    determinant = a11 * a22 - a12 * a12
    if a11 < 1e-6 or determinant < 1e-12:
        return 0.0, 0.0, 0.0, 0.0
    further, wider = (a22 * b1 - a12 * b2) / determinant, (a11 * b2 - a12 * b1) / determinant
    return further, wider, determinant / a22, determinant / a11 - prior - WIDTH_DAMPING


@njit(cache=True, nogil=True)
def place_edge(
    yuyv: NDArray[np.uint8],
    x: float,
    y: float,
    nx: float,
    ny: float,
    width: float,
    prior: float,
    inner: NDArray[np.float64],
    direction: NDArray[np.float64],
    scores: NDArray[np.float64],
    pairs: NDArray[np.float64],
) -> tuple[float, float, float, float]:
    """How far outside (x, y) the edge lies, px; over how many light mixes; what is known of both.

    That is information per score variance, 0 where there is no edge. (nx, ny): unit normal
    outwards. width: px over which light seems to mix, and prior: information that it does, 0 where
    it is but a start. inner, direction, scores: as `encoding.mixture_scores` has them. pairs:
    (PAIRS_MAX, 3) scratch.
    """
    width = min(max(width, WIDTH_MIN_PX), MIXING_MAX_PX)
    across = 0.5 * width + ASIDE_PX
    count = _gather(yuyv, x, y, nx, ny, across, inner, direction, pairs)
    shift = information = of_width = 0.0
    seeming = width
    for _ in range(STEPS):
        further, wider, information, of_width = _improve(
            scores, pairs, count, shift, width, seeming, prior
        )
        if information == 0.0:
            return 0.0, width, 0.0, 0.0
        shift += min(max(further, -1.0), 1.0)
        width = min(max(width + min(max(wider, -1.0), 1.0), WIDTH_MIN_PX), MIXING_MAX_PX)
        if abs(shift) > SHIFT_MAX_PX + 0.25 * width:
            return 0.0, width, 0.0, 0.0
        if abs(further) < 0.005:
            break
    return shift, width, information, of_width
