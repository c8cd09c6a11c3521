"""Groups of regions that may be the object, and what speaks for each, in one compiled call."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.finding.groups import groups_of
from naod.finding.hue import CLIP, Own
from naod.finding.measure import COLOUR, CORE, NO_SHAPE, RING, measure_groups
from naod.finding.presence import log_odds, plausibility

Groups = tuple[
    NDArray[np.int64],
    NDArray[np.int64],
    NDArray[np.float64],
    NDArray[np.int64],
    NDArray[np.float64],
    NDArray[np.float64],
]


@njit(cache=True, nogil=True)
def score_groups(
    labels: NDArray[np.int32],
    table: NDArray[np.int64],
    told: NDArray[np.float64],
    differences: NDArray[np.int32],
    means: NDArray[np.float64],
    pixels_min: int,
    shape: tuple[int, float, float],
    blur: float,
    picture: NDArray[np.uint8],
    own: Own,
    peak: float,
    around_max: float,
    focal_px: float,
    weights: NDArray[np.float64],
) -> Groups:
    """Chosen rows, groups of them, measures, cuts, fitted log-odds, and offsets to those.

    labels, table, told, differences, means: of `Regions`. shape, blur, picture, own: as
    `measure_groups` has them. peak: nat that a pixel of the object's own colour says. around_max:
    nat that surroundings count at most. focal_px: in mask pixels. weights: as `log_odds` has them.
    """
    known = shape[0] != NO_SHAPE
    chosen, groups = groups_of(table, told, pixels_min, known, means)
    measures, cuts = measure_groups(
        labels, table, differences, chosen, groups, shape, blur, picture, own
    )
    for k in range(groups.size):
        # a model that is never quite sure says no less of what it is as sure of as it can be
        measures[k, COLOUR] = min(measures[k, COLOUR] * CLIP / peak, CLIP)
        measures[k, CORE] = min(measures[k, CORE] * CLIP / peak, CLIP)
        measures[k, RING] = min(measures[k, RING], around_max)
    offsets = plausibility(measures, cuts, focal_px) if known else np.zeros(groups.size)
    return chosen, groups, measures, cuts, log_odds(measures, cuts, weights), offsets
