"""Edges of the picture near an outline, and how blurred they are, in kernels."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.alike import COLUMNS, OFFSET, SIGMA, WITHIN
from naod.perception.edges import measure
from naod.perception.profile import colour_at
from naod.pose.around import narrowest, places_around
from naod.pose.contour import VERTICES, seen_outline
from naod.pose.lens import focal
from naod.pose.tally import FOUND, LOOKED, RISE, SHARP_RISE_PX, SPAN, doubt, mixed_px, tell

APART_PX = 2.0
"""Each edge is placed by pixels as far along it: closer ones would say the same again."""

PALETTE = 12
PALETTE_SHARE = 0.6
"""How far out from the middle colours of the object are taken."""

WIDE = 0.2
"""How far from a blob's outline edges are looked for, of its width: shading hides as much of a can
from its colour."""

WIDE_PLATEAU = 0.3
"""Of the way looked outwards or inwards, what the colour of a side is taken from."""

WIDE_SAMPLES = 16
STEP_PX = 0.5
SLOPE_SAMPLES = 5.0
"""Over which a step's slope is taken: it seems no narrower."""

STEP_REACH_PX = 2.0
"""How far from a sharp step nothing of it is seen, and how far it may be from its outline."""

PLATEAU_PX = 2.0
"""What is looked at of either side beyond the step."""

INSIDE = 0.4
"""Of the object's width: so far inside there is surely nothing else."""


@njit(cache=True, nogil=True)
def _palette(
    yuyv: NDArray[np.uint8], places: NDArray[np.float64], count: int
) -> NDArray[np.float64]:
    """(PALETTE, 3) colours of the object well inside an outline of so many places (n, 2) px."""
    x = y = 0.0
    for i in range(count):
        x += places[i, 0] / count
        y += places[i, 1] / count
    colours = np.empty((PALETTE, 3))
    for k in range(PALETTE):
        i = k * count // PALETTE
        dx, dy = places[i, 0] - x, places[i, 1] - y
        colour_at(yuyv, x + PALETTE_SHARE * dx, y + PALETTE_SHARE * dy, colours, k)
    return colours


@njit(cache=True, nogil=True)
def look(
    yuyv: NDArray[np.uint8],
    kind: int,
    half_width: float,
    half_height: float,
    T: NDArray[np.float64],
    lens: NDArray[np.float64],
    most: int,
    wide_px: float,
    points: NDArray[np.float64],
    sigmas: NDArray[np.float64],
    groups: NDArray[np.int64],
    looked: NDArray[np.int64],
    tally: NDArray[np.float64],
) -> int:
    """Edges of the picture near the outline at T (3, 4); returns how many.

    points (most, 2) and sigmas (most,) in px; groups (most,): the edge each is of. looked (4,):
    places the picture shows of each edge.
    wide_px: how far to look, roughly, or WIDE of the object's width if that is more; 0: as near as
    the steps in `tally` are wide, and exactly; then sigmas know which edges are unlike others.
    """
    image, names = np.empty((VERTICES, 3)), np.empty(VERTICES, dtype=np.int64)
    places, normals = np.empty((most, 2)), np.empty((most, 2))
    edges, reaches = np.empty(most, dtype=np.int64), np.empty(most)
    found, mixings = np.zeros((most, COLUMNS)), np.zeros(most)
    pieces = seen_outline(kind, half_width, half_height, T, image, names)
    span = focal(lens) * narrowest(image, pieces)
    count = places_around(image, names, pieces, lens, most, APART_PX, places, normals, edges)
    exact, step, plateau = wide_px == 0.0, STEP_PX, PLATEAU_PX
    reaches[:] = max(wide_px, WIDE * span)
    if exact:
        for i in range(count):
            mixings[i] = mixed_px(tally[RISE + edges[i] % 2], SHARP_RISE_PX)
            reaches[i] = 0.5 * mixings[i] + STEP_REACH_PX + PLATEAU_PX
    else:
        step, plateau = max(STEP_PX, reaches[0] / WIDE_SAMPLES), WIDE_PLATEAU * reaches[0]
    measure(
        yuyv, places, normals, count, reaches, plateau, step, INSIDE * span,
        _palette(yuyv, places, count), exact, mixings, edges, found,
    )  # fmt: skip
    tell(found, edges, count, max(SHARP_RISE_PX, SLOPE_SAMPLES * step), tally)
    doubts = np.zeros(count)
    if exact:
        doubt(found, edges, count, tally, doubts)
    seen = 0
    looked[:] = 0
    for i in range(count):
        if found[i, WITHIN] > 0.0:
            looked[edges[i]] += 1
        if not np.isfinite(found[i, SIGMA]):
            continue
        for c in range(2):
            points[seen, c] = places[i, c] + found[i, OFFSET] * normals[i, c]
        sigmas[seen], groups[seen] = math.hypot(found[i, SIGMA], doubts[i]), edges[i]
        seen += 1
    tally[LOOKED], tally[FOUND], tally[SPAN] = looked.sum(), seen, span
    return seen
