"""How likely a group of regions is the object: logistic regression on a few measures.

The weights are in `weights.toml` and come from `python -m naod.finding.calibration`. Beside what
was fitted stand three terms that pictures of one kind of room could not teach: how far away the
object can be, that it rarely lies, and where it was last seen.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import msgspec
import numpy as np
from numpy.typing import NDArray

from naod.files import read_toml
from naod.finding.measure import (
    ASPECT,
    COLOUR,
    FILL,
    GAP,
    METRE,
    ON_SIDE,
    PIXELS,
    RING,
    TURN,
)

Floats = NDArray[np.float64]

WEIGHTS = Path(__file__).with_name("weights.toml")

NEAREST_M, FARTHEST_M = 0.2, 4.0
BEYOND = 0.15
"""Logarithm of distance beyond those that costs as much as one standard deviation."""

LYING_COST = 3.5
FILL_ENOUGH, FILL_TOLERANCE = 0.7, 0.1
"""So much of the outline is enough, the rest is ribbon or print; what lacks counts squared."""

TURN_FREE = 0.5
"""Rad from which a board's turn counts: it is shown from the front, and seen from about there."""

TOLERANCES_MAX = 6.0
PIXELS_RANGE = (60.0, 2000.0)
"""Fewer do not count against it: it may be far away. More do not count for it."""

PIXELS_MIDDLE = 100.0


class CaseWeights(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Log-odds per unit of each measure; as `naod.finding.measure` has them.

    `pixels` counts per factor e from PIXELS_MIDDLE.
    """

    constant: float = 0.0
    colour: float = 0.0
    ring: float = 0.0
    pixels: float = 0.0
    lack: float = 0.0
    gap: float = 0.0
    aspect: float = 0.0
    turn: float = 0.0


CASES = ("whole", "cut", "unknown")
TERMS = CaseWeights.__struct_fields__


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


def terms(measures: Floats) -> Floats:
    """What the weights are multiplied with, (m, len(TERMS)), from measures (m, MEASURES)."""
    lack = np.maximum(FILL_ENOUGH - measures[:, FILL], 0.0) / FILL_TOLERANCE
    pixels = np.log(np.clip(measures[:, PIXELS], *PIXELS_RANGE) / PIXELS_MIDDLE)
    return np.column_stack(
        [
            np.ones(len(measures)),
            measures[:, COLOUR],
            measures[:, RING],
            pixels,
            np.minimum(lack**2, TOLERANCES_MAX),
            np.minimum(measures[:, GAP], TOLERANCES_MAX),
            np.minimum(np.maximum(measures[:, ASPECT] - 0.5, 0.0), TOLERANCES_MAX),
            np.maximum(measures[:, TURN] - TURN_FREE, 0.0),
        ]
    )


def colour_and_shape(measures: Floats, cuts: NDArray[np.int64], known: bool) -> Floats:
    """Fitted log-odds (m,) of groups with measures (m, MEASURES) and borders that cut them (m,)."""
    weights = fitted_weights()
    rows = terms(measures)
    if not known:
        return np.asarray(rows @ weights["unknown"])
    return np.where(cuts > 0, rows @ weights["cut"], rows @ weights["whole"])


def distance_m(measures: Floats, focal_px: float) -> Floats:
    """Implied distances (m,); focal_px in mask pixels."""
    return np.asarray(focal_px / np.maximum(measures[:, METRE], 1e-9))


def plausibility(measures: Floats, focal_px: float) -> Floats:
    """Log-odds (m,), never positive: where no object is looked for, and that it rarely lies."""
    distance = distance_m(measures, focal_px)
    near, far = np.log(NEAREST_M / distance), np.log(distance / FARTHEST_M)
    beyond = np.maximum(np.maximum(near, far), 0.0) / BEYOND
    return np.asarray(-0.5 * beyond**2 - LYING_COST * measures[:, ON_SIDE])


def probability(log_odds: float) -> float:
    """Of log-odds."""
    return float(1.0 / (1.0 + np.exp(-np.clip(log_odds, -50.0, 50.0))))
