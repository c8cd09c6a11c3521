"""How wrong edge points are."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FLOOR, COMMON, EDGE, PER_BLUR, PER_RISE, PER_ODD, PER_POINT, UNSTEADY, SCATTER = range(9)


@dataclass(frozen=True, slots=True)
class EdgeNoise:
    """How wrong edge points are, in pixels.

    `floor_px`: least standard deviation of one point. `common_px`: the whole outline too wide or
    too narrow, `edge_px`: each edge by itself, both where it is sharp. `edge_per_blur`: px more for
    each over which motion mixes light there. `edge_per_rise`: px over which the sides of a step go
    on as they rise where they are seen: so much of the mixing an edge may be off. `per_odd`: px for
    each by which its steps are unlike the others' of one look. `per_point`: neighbours that err
    together. `fits_px`: a point further away belongs to something else.
    `unsteady_px`: the whole picture to one side where motion during the exposure was not even.
    `scatter_px`: points that scatter more lie before clutter, where all of an edge is worse.
    """

    floor_px: float
    common_px: float
    edge_px: float
    edge_per_blur: float
    edge_per_rise: float
    per_odd: float
    per_point: float
    fits_px: float
    unsteady_px: float = 0.0
    scatter_px: float = math.inf

    @property
    def figures(self) -> NDArray[np.float64]:
        """(9,) as the kernels take them."""
        return np.array(
            [
                self.floor_px,
                self.common_px,
                self.edge_px,
                self.edge_per_blur,
                self.edge_per_rise,
                self.per_odd,
                self.per_point,
                self.unsteady_px,
                self.scatter_px,
            ]
        )
