"""How likely a group of regions is the object: logistic regression on a few measures.

The weights are in `weights.toml` and come from `python -m naod.finding.calibration`. Beside what
was fitted stand terms that pictures of one kind of room could not teach: how far away the object
can be, that it rarely lies, how much of it must be in the picture, and where it was last seen.
"""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import msgspec
import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.files import read_toml
from naod.finding.measure import (
    ASPECT,
    COLOUR,
    CORE,
    FILL,
    GAP,
    HUE,
    METRE,
    ON_SIDE,
    PIXELS,
    RING,
    SHARE,
    TONE,
    TURN,
)
from naod.finding.silhouette import CUT_ACROSS

Floats = NDArray[np.float64]

WEIGHTS = Path(__file__).with_name("weights.toml")

NEAREST_M, FARTHEST_M = 0.2, 4.0
BEYOND = 0.15
"""Logarithm of distance beyond those that costs as much as one standard deviation."""

LYING_COST = 3.5
FILL_ENOUGH, FILL_TOLERANCE = 0.7, 0.1
"""So much of the outline is enough, the rest is ribbon or print; what lacks counts squared."""

CHOSEN = 1.6
"""For what has no known shape: such pictures are chosen by a person, mostly because the object is
in them, and one of many colours is less sure in each of its pixels than those that were fitted."""

TURN_FREE = 0.5
"""Rad from which a board's turn counts: it is shown from the front, and seen from about there."""

RING_FREE, RING_MAX = -1.0, 1.0
"""Nat: what is around counts when it is hardly less like the object than like anything else, and no
more than this: an object may stand before a wall of nearly its colour."""

HUE_FREE, TONE_FREE, WASHED_FREE = 0.5, 0.5, 1.0
"""Tolerances that nobody minds: blur and a ribbon wash a colour out, little makes it more of it."""

SHARE_ENOUGH, GLIMPSE_COST = 0.5, 3.0
"""A glimpse at the picture's left or right border may be of anything, and the head turns there and
sees more. So much of the object is enough; what lacks of that costs so much log-odds, times its
share."""

PALE_FROM, PALE_MAX = 5.0, 4.0
"""Nat: a core surer than that is of the object's very colour; what lacks counts squared, for other
things near that colour stay below while blur leaves the object's own. No more than so many squared
nat count: in half the light the object's own colour is hardly sure."""

TOLERANCES_MAX = 6.0
PIXELS_RANGE = (60.0, 2000.0)
"""Fewer do not count against it: it may be far away. More do not count for it."""

PIXELS_MIDDLE = 100.0


class CaseWeights(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Log-odds per unit of each measure; as `naod.finding.measure` has them.

    `pixels` counts per factor e from PIXELS_MIDDLE. `tone`: more colour than the object's,
    `washed`: less. `blind`: once where there is no picture to see hue and tone in.
    """

    constant: float = 0.0
    colour: float = 0.0
    ring: float = 0.0
    pixels: float = 0.0
    lack: float = 0.0
    gap: float = 0.0
    aspect: float = 0.0
    turn: float = 0.0
    pale: float = 0.0
    hue: float = 0.0
    tone: float = 0.0
    washed: float = 0.0
    blind: float = 0.0


CASES = ("whole", "cut", "unknown")
TERMS = CaseWeights.__struct_fields__
_TERMS = len(TERMS)


class Weights(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """`whole`: shape known, wholly in the picture. `cut`: by its border. `unknown`: no shape."""

    whole: CaseWeights
    cut: CaseWeights
    unknown: CaseWeights


@cache
def fitted_weights() -> dict[str, Floats]:
    """(len(TERMS),) of each case."""
    weights: Weights = read_toml(WEIGHTS, Weights)
    return {case: np.array(msgspec.structs.astuple(getattr(weights, case))) for case in CASES}


@njit(cache=True, nogil=True)
def terms(measures: Floats) -> Floats:
    """What the weights are multiplied with, (m, len(TERMS)), from measures (m, MEASURES)."""
    out = np.empty((measures.shape[0], _TERMS))
    for row, line in zip(measures, out):  # noqa: B905 (numba knows no strict)
        lack = max(FILL_ENOUGH - row[FILL], 0.0) / FILL_TOLERANCE
        pixels = min(max(row[PIXELS], PIXELS_RANGE[0]), PIXELS_RANGE[1])
        line[0] = 1.0
        line[1] = row[COLOUR]
        line[2] = min(max(row[RING] - RING_FREE, 0.0), RING_MAX)
        line[3] = math.log(pixels / PIXELS_MIDDLE)
        line[4] = min(lack**2, TOLERANCES_MAX)
        line[5] = min(row[GAP], TOLERANCES_MAX)
        line[6] = min(max(row[ASPECT] - 0.5, 0.0), TOLERANCES_MAX)
        line[7] = max(row[TURN] - TURN_FREE, 0.0)
        line[8] = min(max(PALE_FROM - row[CORE], 0.0) ** 2, PALE_MAX)
        line[9] = min(max(row[HUE] - HUE_FREE, 0.0), TOLERANCES_MAX)
        line[10] = min(max(row[TONE] - TONE_FREE, 0.0), TOLERANCES_MAX)
        line[11] = min(max(-row[TONE] - WASHED_FREE, 0.0), TOLERANCES_MAX)
        line[12] = 1.0 if row[HUE] < 0.0 else 0.0
    return out


@cache
def weights_of(known: bool) -> Floats:
    """(2, len(TERMS)) for `log_odds`, of a known shape or of none."""
    weights = fitted_weights()
    if known:
        return np.array([weights["whole"], weights["cut"]])
    chosen = weights["unknown"].copy()
    chosen[TERMS.index("constant")] += CHOSEN
    return np.array([chosen, chosen])


@njit(cache=True, nogil=True)
def log_odds(measures: Floats, cuts: NDArray[np.int64], weights: Floats) -> Floats:
    """Fitted log-odds (m,) of groups with measures (m, MEASURES) and borders that cut them (m,).

    weights: (2, len(TERMS)), of what is wholly in the picture and of what is cut.
    """
    out, rows = np.zeros(measures.shape[0]), terms(measures)
    for k in range(out.size):
        for n in range(_TERMS):
            out[k] += rows[k, n] * weights[1 if cuts[k] > 0 else 0, n]
    return out


def distance_m(measures: Floats, focal_px: float) -> Floats:
    """Implied distances (m,); focal_px in mask pixels."""
    return np.asarray(focal_px / np.maximum(measures[:, METRE], 1e-9))


@njit(cache=True, nogil=True)
def plausibility(measures: Floats, cuts: NDArray[np.int64], focal_px: float) -> Floats:
    """Log-odds (m,), never positive: where no object is looked for, how it lies, and glimpses."""
    out = np.empty(measures.shape[0])
    for k in range(out.size):
        distance = focal_px / max(measures[k, METRE], 1e-9)
        beyond = max(math.log(NEAREST_M / distance), math.log(distance / FARTHEST_M), 0.0) / BEYOND
        lack = max(SHARE_ENOUGH - measures[k, SHARE], 0.0) if cuts[k] & CUT_ACROSS else 0.0
        out[k] = -0.5 * beyond**2 - LYING_COST * measures[k, ON_SIDE] - GLIMPSE_COST * lack
    return out


def probability(log_odds: float) -> float:
    """Of log-odds."""
    return 1.0 / (1.0 + math.exp(-min(max(log_odds, -50.0), 50.0)))
