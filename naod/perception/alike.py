"""Edges put where their pixels say, each by itself and then knowing what others like it tell.

Where an edge falls among the pixels decides whether they tell how wide it is; those of one
direction are equally wide.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.placing import place_edge

GATHERED2 = 0.9
"""Variance that shared chroma and bilinear samples add to a profile along a row, px squared."""

OFFSET, SIGMA, WIDTH, WITHIN, UNEVEN, GOES = range(6)
COLUMNS = 6
"""Of what is measured at a place; `UNEVEN`: by how much of the step the two sides rise per px;
`GOES`: as `goes_to` has it, 0 where nothing moved much."""

MIXING, OF_WIDTH, CONTRAST, INNER, DIRECTION, KEPT = 0, 1, 2, 3, 6, 9
"""Of an edge that is placed: px over which it mixes light, information about that, its contrast,
and the inner colour and direction of its two sides."""

ALIKE_PX, ALIKE_SHARE = 0.1, 0.05
"""Standard deviation of the widths over which edges along one direction mix light, and of such a
width, its share."""

SHARP_PX, SHARP_INFORMATION, SHARP_UNTIL_PX = 1.05, 300.0, 1.0
"""Over so much light mixes without motion: the pixel itself. How surely that is so where steps are
no wider than without motion, and the motion from which nothing of it is left. What few edges say of
their widths must not count for more: those that seem wide say more of it than sharp ones."""


@njit(cache=True, nogil=True)
def seeming_px(normal: NDArray[np.float64], width: float) -> float:
    """Px over which light mixes, by the width of a step along a normal."""
    gathered2 = GATHERED2 * normal[0] ** 2 + 0.2 * normal[1] ** 2
    return math.sqrt(max(width * width - 12.0 * gathered2, 1.0))


@njit(cache=True, nogil=True)
def put_edge(
    yuyv: NDArray[np.uint8],
    place: NDArray[np.float64],
    normal: NDArray[np.float64],
    width: float,
    prior: float,
    curve: NDArray[np.float64],
    pairs: NDArray[np.float64],
    kept: NDArray[np.float64],
    found: NDArray[np.float64],
) -> None:
    """Put an edge where its pixels say; nothing is changed where they do not."""
    shift, mixing, information, of_width = place_edge(
        yuyv, place[0] + found[OFFSET] * normal[0], place[1] + found[OFFSET] * normal[1],
        normal[0], normal[1], width, prior, kept[INNER:DIRECTION], kept[DIRECTION:KEPT], curve,
        pairs,
    )  # fmt: skip
    if not information > 0.0:
        return
    contrast = kept[CONTRAST]
    found[OFFSET] += shift
    found[SIGMA] = 1.0 / (contrast * math.sqrt(information))
    kept[MIXING], kept[OF_WIDTH] = mixing, max(of_width, 0.0) * contrast * contrast


@njit(cache=True, nogil=True)
def _sharpness(
    normals: NDArray[np.float64],
    groups: NDArray[np.int64],
    side: int,
    count: int,
    found: NDArray[np.float64],
) -> float:
    """Information there is without looking that edges of a pair are sharp, by how they seem."""
    seeming, n = np.empty(count), 0
    for i in range(count):
        if groups[i] % 2 == side and np.isfinite(found[i, SIGMA]):
            seeming[n] = seeming_px(normals[i], found[i, WIDTH])
            n += 1
    if n == 0:
        return 0.0
    motion = float(np.median(seeming[:n])) - SHARP_PX
    return SHARP_INFORMATION * min(max(1.0 - motion / SHARP_UNTIL_PX, 0.0), 1.0)


@njit(cache=True, nogil=True)
def _usual(
    kept: NDArray[np.float64], groups: NDArray[np.int64], side: int, count: int, sharp: float
) -> float:
    """Median of the widths over which a pair of edges mixes light, by what is known of each.

    sharp: information that it is SHARP_PX. 0 where nothing is known.
    """
    widths, known, n = np.full(count + 1, SHARP_PX), np.full(count + 1, sharp), 1
    for i in range(count):
        if groups[i] % 2 == side:
            widths[n], known[n] = kept[i, MIXING], kept[i, OF_WIDTH]
            n += 1
    total, below = known[:n].sum(), 0.0
    for i in np.argsort(widths[:n]):
        below += known[i]
        if total > 0.0 and 2.0 * below >= total:
            return float(widths[i])
    return 0.0


@njit(cache=True, nogil=True)
def place_alike(
    yuyv: NDArray[np.uint8],
    places: NDArray[np.float64],
    normals: NDArray[np.float64],
    count: int,
    groups: NDArray[np.int64],
    curves: NDArray[np.float64],
    pairs: NDArray[np.float64],
    kept: NDArray[np.float64],
    found: NDArray[np.float64],
) -> None:
    """Place edges again that mix light over another width than their neighbours seem to.

    Where an edge falls on the border of two pixels it may be sharp, or wider and a bit further out:
    they look the same. The others of its direction tell.
    """
    for side in range(2):
        sharp = _sharpness(normals, groups, side, count, found)
        usual = _usual(kept, groups, side, count, sharp)
        spread = ALIKE_PX + ALIKE_SHARE * usual
        for i in range(count):
            if groups[i] % 2 != side or kept[i, OF_WIDTH] == 0.0:
                continue
            if abs(kept[i, MIXING] - usual) >= ALIKE_PX:
                prior = 1.0 / (spread * kept[i, CONTRAST]) ** 2
                put_edge(
                    yuyv, places[i], normals[i], usual, prior, curves[i], pairs, kept[i], found[i]
                )
