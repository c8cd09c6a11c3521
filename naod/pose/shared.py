"""Offsets that the points of an edge have in common: fitted together with the pose.

A blurred edge, one before a wall of uneven colour or one that shades off, is seen too far out or
in over its whole length, and so many points agree on what is wrong. So each edge has an offset of
its own with a known spread, which costs nothing where others contradict it.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

DEGREES = 6.0

WEIGHTED = 1.27
"""Variance of an estimate with Geman-McClure weights at OUTLIER deviations of normal noise, over
what the weighted residuals give as if the weights had been known beforehand."""

ODD = 2.5
"""Standard deviations of an edge's offset at which it counts for a quarter."""


@njit(cache=True, nogil=True)
def point_sigma(
    residuals: NDArray[np.float64],
    weights: NDArray[np.float64],
    trust: NDArray[np.float64],
    groups: NDArray[np.int64],
    offsets: NDArray[np.float64],
    floor: float,
) -> float:
    """Standard deviation of an edge point of full trust, from residuals (n,), in their unit.

    weights: (n,) after down-weighting outliers. trust: (n,) as the points come. groups: (n,) which
    of the offsets (4,) is theirs.
    """
    squares = total = 0.0
    for i in range(residuals.size):
        gap = residuals[i] - offsets[groups[i]]
        squares += weights[i] * trust[i] * gap * gap
        total += weights[i]
    return max(floor, math.sqrt(WEIGHTED * squares / max(total - DEGREES, 1.0)))


@njit(cache=True, nogil=True)
def give_way(
    pulls: NDArray[np.float64],
    sums: NDArray[np.float64],
    residual_sums: NDArray[np.float64],
    spreads: NDArray[np.float64],
    sigma: float,
    offsets: NDArray[np.float64],
    gains: NDArray[np.float64],
    A: NDArray[np.float64],
    b: NDArray[np.float64],
) -> None:
    """Take the edges' offsets (4,), which are filled, out of normal equations A (6, 6) and b (6,).

    pulls (4, 6), sums (4,), residual_sums (4,): of the points' weights times derivatives, of the
    weights, and of the weights times residuals. spreads (4,): standard deviations of the offsets;
    that of an edge at odds with the others is taken to be larger. sigma: that of a point of weight
    1. gains (4,): filled with how much of an edge's sum is taken for its offset. The lower half of
    A is enough.
    """
    gains[:] = 0.0
    for edge in range(4):
        if not spreads[edge] > 0.0 or sums[edge] <= 0.0:
            continue
        odd = offsets[edge] / (ODD * spreads[edge])
        variance = (spreads[edge] * (1.0 + odd * odd) / sigma) ** 2
        gain = variance / (1.0 + variance * sums[edge])
        gains[edge], offsets[edge] = gain, gain * residual_sums[edge]
        for j in range(6):
            b[j] += gain * pulls[edge, j] * residual_sums[edge]
            for k in range(j + 1):
                A[j, k] -= gain * pulls[edge, j] * pulls[edge, k]
