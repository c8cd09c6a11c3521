"""From the region that a person marked to the whole object in the same picture.

The object's colours are those that the region has more of than the rest of the picture, shades of
them included. What is found by them teaches the colours again, and so on; near the convex hull of
what was found a pixel is likelier object, far from it less.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from naod.perception.colour_model import Region
from naod.perception.colour_table import CELLS, cells_of, smoothed
from naod.perception.components import BOTTOM, LEFT, RIGHT, TOP, components
from naod.perception.energy import STEPS
from naod.perception.optimum import Optimum

Mask = NDArray[np.bool_]
Shares = NDArray[np.float64]

BETA = 1.0
ROUNDS = 6
SHADES = ((0.6, 0.1), (0.8, 0.2), (1.0, 0.4), (1.25, 0.2), (1.5, 0.1))
"""Brightness of the object's other sides relative to what is known of it, and how often."""
MARKED_WEIGHT = 2.0
"""Of a marked pixel among those that were only found."""
UNKNOWN_SHARE = 2e-4
"""Share of a part that any one cell of colour may have without having been seen."""
COLOUR_MAX, HULL, AWAY = 4.0, 0.5, 2.0
"""In nat: at most from colour; for lying in the hull; against, per object's side outside of it."""
NEVER = 20.0

_NO_COLOUR = np.array([0.0, 128.0, 128.0], dtype=np.float32)


def region_mask(region: Region, block: int, shape: tuple[int, int]) -> Mask:
    """(h, w) bool: reduced pixels that lie wholly in a region of the full picture.

    `block`: full pixels per reduced pixel. At least the one in its middle.
    """
    mask = np.zeros(shape, dtype=np.bool_)
    spans = []
    for begin, length in ((region.y, region.height), (region.x, region.width)):
        first, last = -(-begin // block), (begin + length) // block
        if last <= first:
            first = (begin + length // 2) // block
            last = first + 1
        spans.append(slice(first, last))
    mask[spans[0], spans[1]] = True
    return mask


def grown(picture: NDArray[np.float32], region: Mask) -> Mask:
    """The object of which `region` (h, w) is a part, in a picture (h, w, 3) Y U V; (h, w) bool."""
    own = cells_of(picture)
    shades = [
        (cells_of((picture - _NO_COLOUR) * np.float32(gain) + _NO_COLOUR), share)
        for gain, share in SHADES
    ]
    optimum = Optimum(*region.shape)
    labels = np.empty(region.shape, dtype=np.uint8)
    inside = region
    for _ in range(ROUNDS):
        odds = _colour_odds(own, shades, inside, region) + _place_odds(inside)
        differences = np.rint(-STEPS * odds).astype(np.int32)
        differences[region] = round(-NEVER * STEPS)
        optimum.minimise(differences, round(BETA * STEPS), labels)
        found = _without_holes(_touching(labels, region))
        if (found == inside).all():
            break
        inside = found
    return inside


def _colour_odds(
    own: NDArray[np.int64],
    shades: list[tuple[NDArray[np.int64], float]],
    inside: Mask,
    region: Mask,
) -> Shares:
    """(h, w) nat by which each pixel's colour is commoner inside than outside."""
    weights = np.where(region[inside], MARKED_WEIGHT, 1.0)
    shares = np.zeros(CELLS)
    for cells, share in shades:
        shares += share * np.bincount(cells[inside], weights=weights, minlength=CELLS)
    outside = np.bincount(own[~inside], minlength=CELLS).astype(np.float64)
    object_ = smoothed(shares / weights.sum()) + UNKNOWN_SHARE
    behind = smoothed(outside / max(outside.sum(), 1.0)) + UNKNOWN_SHARE
    return np.clip(np.log(object_ / behind), -COLOUR_MAX, COLOUR_MAX)[own]


def _place_odds(inside: Mask) -> Shares:
    """(h, w) nat by which each pixel's place speaks for the object."""
    rows, columns = np.nonzero(inside)
    hull = cv2.convexHull(np.stack([columns, rows], axis=1).astype(np.int32))
    outside = np.ones(inside.shape, dtype=np.uint8)
    cv2.fillConvexPoly(outside, hull, 0)
    away = cv2.distanceTransform(outside, cv2.DIST_L2, 3) / np.sqrt(len(rows))
    return np.where(outside > 0, -AWAY * away, HULL)


def _touching(labels: NDArray[np.uint8], region: Mask) -> Mask:
    """The region and the parts of a mask that share pixels with it."""
    parts, table = components(labels)
    wanted = np.bincount(parts[region], minlength=len(table) + 1) > 0
    wanted[0] = False
    return np.asarray(region | wanted[parts], dtype=np.bool_)


def _without_holes(inside: Mask) -> Mask:
    """With what it encloses."""
    height, width = inside.shape
    parts, table = components((~inside).astype(np.uint8))
    open_ = np.zeros(len(table) + 1, dtype=np.bool_)
    open_[1:] = (table[:, LEFT] == 0) | (table[:, RIGHT] == width - 1)
    open_[1:] |= (table[:, TOP] == 0) | (table[:, BOTTOM] == height - 1)
    return np.asarray(~open_[parts], dtype=np.bool_)
