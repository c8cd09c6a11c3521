"""What the edges of one look tell together: how blurred they are, and which are unlike others."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.alike import GOES, OFFSET, SIGMA, UNEVEN, WIDTH

LOOKED, FOUND, BLUR, SPAN, MOVED, RISE, RISE_ASIDE, UNEVEN_SIDES, ODD_SIDES = (
    0, 1, 2, 3, 4, 5, 6, 7, 11,
)  # fmt: skip
TALLY = 15
"""Of a tally: places looked at, edges found there, width of the more blurred ones, the object's
width, how far most edges were from where they were looked for, the width of steps at top and
bottom, and at the sides, px; for each edge by how much of its step its two sides rise per px; and
for each how unlike the others its steps are, px.
"""

SHARP_RISE_PX = 3.2
"""Width of a step without motion, as bilinear samples of shared chroma show it."""

BLURRED_SHARE = 0.8
"""Motion blurs the edges across it: the width of an edge that four of five do not reach."""

MOST_SHARE = 0.7

ODD_FROM_PX = 5.0
"""Steps as wide as this are motion's, and all of one direction equally wide."""

WIDTH_SLACK, PACE_SLACK = 0.1, 0.1
"""Shares by which the width of a step, and where it would go in the pace it begins with, may be
another than that of the others."""

OFF_BY_WIDTH, OFF_BY_PACE = 0.5, 0.4
"""Standard deviation of an edge of a step that is unlike the others, of the difference and of the
step: there something else begins within the motion."""


@njit(cache=True, nogil=True)
def mixed_px(rise_px: float, least_px: float) -> float:
    """Px over which motion mixes light, by the width of a step and that of one without motion."""
    return math.sqrt(max(rise_px * rise_px - least_px * least_px, 0.0))


@njit(cache=True, nogil=True)
def aliased(mixed_px: float) -> float:
    """What is left of the errors that a sharp step has by where it falls among the pixels."""
    return 1.0 / (1.0 + 0.5 * mixed_px)


@njit(cache=True, nogil=True)
def _middle(
    found: NDArray[np.float64], edges: NDArray[np.int64], count: int, side: int, column: int
) -> float:
    """Median of what is above 0 of a column, over the edges found of a pair; 0 without any."""
    values, n = np.empty(count), 0
    for i in range(count):
        if np.isfinite(found[i, SIGMA]) and edges[i] % 2 == side and found[i, column] > 0.0:
            values[n] = found[i, column]
            n += 1
    return float(np.median(values[:n])) if n else 0.0


@njit(cache=True, nogil=True)
def tell(
    found: NDArray[np.float64],
    edges: NDArray[np.int64],
    count: int,
    least_px: float,
    tally: NDArray[np.float64],
) -> None:
    """Widths of steps, their sides and distances from the outline, into `tally`.

    found: as `measure` fills it, at places that are of `edges` (n,). least_px: width of a step
    without motion as it was looked at.
    """
    widths, moves = np.empty(count), np.empty(count)
    seen = 0
    for i in range(count):
        if np.isfinite(found[i, SIGMA]):
            widths[seen], moves[seen] = found[i, WIDTH], abs(found[i, OFFSET])
            seen += 1
    tally[BLUR] = np.sort(widths[:seen])[int(BLURRED_SHARE * seen)] if seen else 0.0
    tally[MOVED] = np.sort(moves[:seen])[int(MOST_SHARE * seen)] if seen else 0.0
    for edge in range(4):
        n, rise = 0, 0.0
        for i in range(count):
            if np.isfinite(found[i, SIGMA]) and edges[i] == edge:
                rise += found[i, UNEVEN]
                n += 1
        tally[UNEVEN_SIDES + edge] = abs(rise) / max(n, 1)
    for side in range(2):
        typical = _middle(found, edges, count, side, WIDTH)
        wide = mixed_px(typical if typical > 0.0 else tally[BLUR], least_px)
        tally[RISE + side] = math.hypot(SHARP_RISE_PX, wide)


@njit(cache=True, nogil=True)
def doubt(
    found: NDArray[np.float64],
    edges: NDArray[np.int64],
    count: int,
    tally: NDArray[np.float64],
    doubts: NDArray[np.float64],
) -> None:
    """Fill by how much edges (n,) may be off, px, whose steps are unlike the others of their pair.

    Their mean along each edge goes into `tally`: where some are off, what seems to fit may be, too.
    """
    many = np.zeros(4, dtype=np.int64)
    tally[ODD_SIDES : ODD_SIDES + 4] = 0.0
    doubts[:count] = 0.0
    for side in range(2):
        width = _middle(found, edges, count, side, WIDTH)
        goes = _middle(found, edges, count, side, GOES)
        for i in range(count):
            if edges[i] % 2 != side or not np.isfinite(found[i, SIGMA]):
                continue
            many[edges[i]] += 1
            if width < ODD_FROM_PX:
                continue
            other = max(abs(found[i, WIDTH] / width - 1.0) - WIDTH_SLACK, 0.0)
            paced = 0.0
            if found[i, GOES] > 0.0:
                paced = max(abs(found[i, GOES] / goes - 1.0) - PACE_SLACK, 0.0)
            doubts[i] = width * math.hypot(OFF_BY_WIDTH * other, OFF_BY_PACE * paced)
            tally[ODD_SIDES + edges[i]] += doubts[i]
    for edge in range(4):
        tally[ODD_SIDES + edge] /= max(many[edge], 1)
