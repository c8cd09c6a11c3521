"""From the region that a person marked to the whole object in the same picture.

The object's colours are those that the region has more of than the rest of the picture, shades of
them included. What is found by them teaches the colours again, and so on; near the convex hull of
what was found a pixel is likelier object, far from it less. Its outline keeps to edges of the
picture, so that what touches the object and has nearly its colour stays outside.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from naod.perception.colour_model import Region
from naod.perception.colour_table import CELLS, cells_of, smoothed
from naod.perception.components import BOTTOM, LEFT, RIGHT, TOP, components
from naod.perception.energy import STEPS
from naod.perception.growing_cut import least_energy, pair_weights
from naod.perception.growing_parts import hull_of, joined

Mask = NDArray[np.bool_]
Shares = NDArray[np.float64]
Pixels = NDArray[np.float32]
Weights = NDArray[np.int32]

BETA, BETA_LEAST = 6.0, 0.1
"""In nat, between neighbours of one colour; share of it that is left across the strongest edges."""
CONTRAST, CHROMA = 0.3, 3.0
"""Of the picture's mean square difference between neighbours; U and V beside Y."""
EVEN, ZONE_WEIGHT = 0.85, 0.1
"""Share of beta above which neighbours have no edge between them; what a pixel that is reached so
from the region counts among the background's, for it may well be the object's."""
ROUNDS = 8
SHADES = ((0.75, 0.25), (1.0, 0.5), (1.3, 0.25))
"""Brightness of the object's other sides relative to what is known of it, and how often."""
MARKED_WEIGHT = 2.0
"""Of a marked pixel among those that were only found."""
UNKNOWN_SHARE = 2e-4
"""Share of a part that any one cell of colour may have without having been seen."""
COLOUR_MAX, HULL, AWAY = 4.0, 1.0, 2.0
"""In nat: at most from colour; for lying in the hull; against, per object's side outside of it."""
NEVER = 20.0
MARGIN, MARGIN_MIN = 1.5, 12
"""Of what is looked at around what was found, in sides of it, and in pixels."""

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


def grown(picture: Pixels, region: Mask) -> Mask:
    """The object of which `region` (h, w) is a part, in a picture (h, w, 3) Y U V; (h, w) bool."""
    own = cells_of(picture)
    shades = [
        (cells_of((picture - _NO_COLOUR) * np.float32(gain) + _NO_COLOUR), share)
        for gain, share in SHADES
    ]
    weights = pair_weights(picture, round(BETA * STEPS), BETA_LEAST, CONTRAST, CHROMA)
    others = np.where(_even_zone(weights, region), ZONE_WEIGHT, 1.0)
    inside = region
    for _ in range(ROUNDS):
        odds = _colour_odds(shades, own, inside, region, others)
        near = _around(inside)
        found = np.zeros_like(region)
        found[near] = _found(odds[own[near]], weights[:, near[0], near[1]], inside[near],
                             region[near])  # fmt: skip
        found = _without_holes(found)
        if (found == inside).all():
            break
        inside = found
    return inside


def _found(odds: Shares, weights: Weights, inside: Mask, region: Mask) -> Mask:
    """One round's object in a window, from the odds of colours (h, w)."""
    differences = np.rint(-STEPS * (odds + _place_odds(inside))).astype(np.int32)
    differences[region] = round(-NEVER * STEPS)
    parts, table = components(least_energy(differences, np.ascontiguousarray(weights)))
    wanted = np.bincount(parts[region], minlength=len(table) + 1) > 0
    wanted[0] = False
    return joined(region | wanted[parts], parts, table, weights)


def _around(inside: Mask) -> tuple[slice, slice]:
    """Rows and columns of what is looked at."""
    spans = []
    margin = max(round(MARGIN * float(np.sqrt(np.count_nonzero(inside)))), MARGIN_MIN)
    for axis in (1, 0):
        places = np.flatnonzero(inside.any(axis=axis))
        spans.append(slice(max(int(places[0]) - margin, 0), int(places[-1]) + 1 + margin))
    return spans[0], spans[1]


def _colour_odds(
    shades: list[tuple[NDArray[np.int64], float]],
    own: NDArray[np.int64],
    inside: Mask,
    region: Mask,
    others: Shares,
) -> Shares:
    """(CELLS,) nat by which each colour is commoner inside than outside.

    others: (h, w) what each pixel counts while it is outside.
    """
    weights = np.where(region[inside], MARKED_WEIGHT, 1.0)
    shares = np.zeros(CELLS)
    for cells, share in shades:
        shares += share * np.bincount(cells[inside], weights=weights, minlength=CELLS)
    outside = np.bincount(own[~inside], weights=others[~inside], minlength=CELLS)
    object_ = smoothed(shares / weights.sum()) + UNKNOWN_SHARE
    behind = smoothed(outside / max(outside.sum(), 1.0)) + UNKNOWN_SHARE
    return np.clip(np.log(object_ / behind), -COLOUR_MAX, COLOUR_MAX)


def _even_zone(weights: Weights, region: Mask) -> Mask:
    """(h, w) what can be reached from the region without crossing an edge."""
    even = np.ones(region.shape, dtype=np.bool_)
    least = EVEN * BETA * STEPS
    even[:, :-1] &= weights[0, :, :-1] >= least
    even[:-1] &= weights[1, :-1] >= least
    parts, table = components(even.astype(np.uint8))
    reached = np.bincount(parts[region], minlength=len(table) + 1) > 0
    reached[0] = False
    return np.asarray(reached[parts], dtype=np.bool_)


def _place_odds(inside: Mask) -> Shares:
    """(h, w) nat by which each pixel's place speaks for the object."""
    outside = (~hull_of(inside)).astype(np.uint8)
    away = cv2.distanceTransform(outside, cv2.DIST_L2, 3) / np.sqrt(np.count_nonzero(inside))
    return np.where(outside > 0, -AWAY * away, HULL)


def _without_holes(inside: Mask) -> Mask:
    """With what it encloses."""
    height, width = inside.shape
    parts, table = components((~inside).astype(np.uint8))
    open_ = np.zeros(len(table) + 1, dtype=np.bool_)
    open_[1:] = (table[:, LEFT] == 0) | (table[:, RIGHT] == width - 1)
    open_[1:] |= (table[:, TOP] == 0) | (table[:, BOTTOM] == height - 1)
    return np.asarray(~open_[parts], dtype=np.bool_)
