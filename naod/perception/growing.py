"""From the region that a person marked to the whole object in the same picture."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from naod.perception.colour_model import Region
from naod.perception.components import components
from naod.perception.energy import STEPS
from naod.perception.optimum import Optimum

BETA = 1.0
TOUCHED_SHARE = 0.05
"""Of the marked region, what a part of the object has to cover to be taken for one."""


def region_mask(region: Region, block: int, shape: tuple[int, int]) -> NDArray[np.bool_]:
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


def grown(differences: NDArray[np.int32], region: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The region and the parts of the least-energy mask that share enough of it, (h, w) bool."""
    labels = np.empty(differences.shape, dtype=np.uint8)
    height, width = differences.shape
    Optimum(height, width).minimise(differences, round(BETA * STEPS), labels)
    parts, table = components(labels)
    shared = np.bincount(parts[region], minlength=len(table) + 1)
    wanted = shared >= max(TOUCHED_SHARE * np.count_nonzero(region), 1)
    wanted[0] = False
    return np.asarray(region | wanted[parts], dtype=np.bool_)
