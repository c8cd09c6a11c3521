"""Where and how a profile of colours goes from one side of an edge to the other, in kernels."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

SLOPE_MIN = 0.02
SLOW_PX = 5.0
"""A step that seems to rise over more than this at its middle is asked how far its quarters are."""

BEGINS = 0.1
"""Share of the outer side's light from which a step has begun."""

ROUNDED_PX = 1.0
"""The lens and the pixels round the beginning of a step over so much."""

BEGINNING = 0.6
"""Of the motion, what is looked at of a step's beginning: what comes later may be another's."""

PACE_SAMPLES = 4


@njit(cache=True, nogil=True)
def _split(scores: NDArray[np.float64], count: int, level: float) -> int:
    """Last sample inside, for the step that fits the whole profile best; -1 if there is none."""
    total, best, at = 0.0, 0.0, -1
    for k in range(count - 1):
        total += level - min(max(scores[k], -0.2), 1.2)
        if total > best:
            best, at = total, k
    return at


@njit(cache=True, nogil=True)
def _slope(scores: NDArray[np.float64], count: int, k: int, step: float) -> float:
    """Rise per pixel about the step after sample k; 0 where the profile ends too soon."""
    if k < 2 or k > count - 4:
        return 0.0
    return (scores[k + 3] - scores[k - 2]) / (5.0 * step)


@njit(cache=True, nogil=True)
def crossing(
    colours: NDArray[np.float64],
    count: int,
    inner: NDArray[np.float64],
    direction: NDArray[np.float64],
    level: float,
    step: float,
    scores: NDArray[np.float64],
) -> tuple[float, float]:
    """Which sample of a profile, in fractions, is at a level, and its slope; slope 0 if none."""
    for k in range(count):
        scores[k] = 0.0
        for c in range(3):
            scores[k] += direction[c] * (colours[k, c] - inner[c])
    k = _split(scores, count, level)
    slope = _slope(scores, count, k, step)
    if slope < SLOPE_MIN or not scores[k] <= level < scores[k + 1]:
        return 0.0, 0.0
    place = k + (level - scores[k]) / (scores[k + 1] - scores[k])
    return place, slope


@njit(cache=True, nogil=True)
def _rise(
    scores: NDArray[np.float64], count: int, at: float, shares: NDArray[np.float64], step: float
) -> float:
    """Px over which light mixes, from where a quarter of it and three quarters are of one side."""
    quarter = shares.size // 4
    lower, upper = shares[quarter], shares[shares.size - 1 - quarter]
    first, last = int(at), int(at) + 1
    while first > 0 and scores[first] > lower:
        first -= 1
    while last < count - 1 and scores[last] < upper:
        last += 1
    begin, end = float(first), float(last)
    if scores[first + 1] > scores[first]:
        begin += min(max((lower - scores[first]) / (scores[first + 1] - scores[first]), 0.0), 1.0)
    if scores[last] > scores[last - 1]:
        end -= min(max((scores[last] - upper) / (scores[last] - scores[last - 1]), 0.0), 1.0)
    return 2.0 * (end - begin) * step


@njit(cache=True, nogil=True)
def unevenness(scores: NDArray[np.float64], count: int, few: int, step: float) -> float:
    """By how much of the step a profile's outermost few samples rise per px, both sides together.

    Sides that are not flat hide how far the step goes up or down.
    """
    half, rise = few // 2, 0.0
    for k in range(half):
        inner = scores[few - half + k] - scores[k]
        rise += scores[count - half + k] - scores[count - few + k] + inner
    return rise / (half * (few - half) * step)


@njit(cache=True, nogil=True)
def width_of(
    scores: NDArray[np.float64],
    count: int,
    at: float,
    slope: float,
    shares: NDArray[np.float64],
    step: float,
) -> float:
    """Px over which a step rises, by its slope, or where that is slow by its quarters."""
    if 1.0 / slope <= SLOW_PX:
        return 1.0 / slope
    return max(_rise(scores, count, at, shares, step), SLOW_PX)


@njit(cache=True, nogil=True)
def _share(shares: NDArray[np.float64], score: float) -> float:
    """Share of the outer side's light in a mixture with a score, as `mixture_scores` has them."""
    last = shares.size - 1
    for k in range(last):
        if score < shares[k + 1] or k == last - 1:
            rise = shares[k + 1] - shares[k]
            return (k + (score - shares[k]) / rise) / last if rise > 0.0 else k / last
    return 1.0


@njit(cache=True, nogil=True)
def goes_to(
    scores: NDArray[np.float64],
    count: int,
    at: float,
    shares: NDArray[np.float64],
    step: float,
    mixed_px: float,
) -> float:
    """How far a step would go in the pace it begins with, 1: to the outer side; 0 if unknown.

    Motion mixes light evenly over `mixed_px`, so that the beginning of a step tells what is just
    outside the edge, whatever follows there within the same motion.
    """
    begun = int(at)
    while begun > 0 and _share(shares, scores[begun]) > BEGINS:
        begun -= 1
    first = begun + int(ROUNDED_PX / step)
    last = min(begun + int(BEGINNING * mixed_px / step), count - 1)
    if last - first + 1 < PACE_SAMPLES:
        return 0.0
    middle, along, square = 0.5 * (first + last), 0.0, 0.0
    for i in range(first, last + 1):
        along += (i - middle) * _share(shares, scores[i])
        square += (i - middle) ** 2
    return along / (square * step) * mixed_px
