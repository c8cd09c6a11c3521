"""What the outline of a known shape would be at a glance, from the box or the corners of a hull.

Far away and without perspective: a cylinder is a box with an arc at each end, a rectangle a
parallelogram. Good enough to tell it from other things, and quick; the pose comes later.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.finding.hull import Points

ARC = 8
OUTLINE_MAX = 2 * (ARC + 1)
LYING_SHARE = 0.15
"""Logarithm of proportions an upright object may miss before it is taken for lying."""

ASIDE = 0.7
"""Logarithm by which looking from the side may narrow one."""

ABOVE = 0.15
"""Logarithm by which looking from above may lower an upright rectangle."""

MISFIT, TURN_AWAY, SCALE, LYING, SHOWN = range(5)
"""Columns of a silhouette: logarithm by which its proportions cannot be had from any side, how far
a rectangle is turned out of the picture's plane (rad), mask pixels per metre, 1 where it lies, and
at most how much of it the picture's border leaves to be seen, of its area."""

CUT_ACROSS, CUT_ALONG = 1, 2
"""Bits of `cut`: the picture's left or right border, its upper or lower one, ends the region."""


@njit(cache=True, nogil=True)
def _cylinder_tilt(ratio: float, level: float, cut: int) -> tuple[float, float]:
    """Misfit and tilt of a cylinder `ratio` times as high as wide; `level`: of one seen level.

    A little too low is a matter of blur and pixels: nobody looks at a can from straight above.
    """
    most = math.hypot(level, 1.0)
    turn = math.atan(1.0 / level)
    if ratio > most:
        return (0.0 if cut & CUT_ACROSS else math.log(ratio / most)), turn
    if ratio < level:
        return (0.0 if cut & CUT_ALONG else math.log(level / ratio)), 0.0
    return 0.0, max(turn - math.acos(ratio / most), 0.0)


@njit(cache=True, nogil=True)
def cylinder_outline(
    box: NDArray[np.float64],
    radius: float,
    height: float,
    found: NDArray[np.float64],
    outline: Points,
) -> int:
    """A cylinder that fills a box (6,) as `smallest_box` gives it; number of outline points."""
    level = 0.5 * height / radius
    across, along, ux, uy = box[4], box[5], box[2], box[3]
    misfit, tilt = _cylinder_tilt(along / across, level, 0)
    found[LYING] = 0.0
    if misfit > LYING_SHARE:
        other, other_tilt = _cylinder_tilt(across / along, level, 0)
        if other < misfit - LYING_SHARE:
            misfit, tilt = other, other_tilt
            across, along = along, across
            ux, uy = -uy, ux
            found[LYING] = 1.0
    found[MISFIT], found[TURN_AWAY] = misfit, 0.0
    found[SCALE] = 0.5 * across / radius
    rise = 0.5 * across * math.sin(tilt)
    half = max(0.5 * along - rise, 0.0)
    for end in range(2):
        for k in range(ARC + 1):
            angle = math.pi * (k / ARC)
            v = -0.5 * across * math.cos(angle) * (1.0 - 2.0 * end)
            u = (half + rise * math.sin(angle)) * (2.0 * end - 1.0)
            row = end * (ARC + 1) + k
            # u runs down along the box, v to the right of it
            outline[row, 0] = box[0] + u * ux + v * uy
            outline[row, 1] = box[1] + u * uy - v * ux
    return OUTLINE_MAX


@njit(cache=True, nogil=True)
def _squeeze(ax: float, ay: float, bx: float, by: float) -> tuple[float, float]:
    """Greatest and least stretching of the map whose columns are a and b."""
    e, f, g, h = 0.5 * (ax + by), 0.5 * (ax - by), 0.5 * (ay + bx), 0.5 * (ay - bx)
    large, small = math.hypot(e, h), math.hypot(f, g)
    return large + small, abs(large - small)


@njit(cache=True, nogil=True)
def rectangle_outline(
    corners: Points, width: float, height: float, found: NDArray[np.float64]
) -> None:
    """How a rectangle must be turned to fill four corners (4, 2) in order around."""
    ax = 0.5 * (corners[1, 0] - corners[0, 0] + corners[2, 0] - corners[3, 0])
    ay = 0.5 * (corners[1, 1] - corners[0, 1] + corners[2, 1] - corners[3, 1])
    bx = 0.5 * (corners[3, 0] - corners[0, 0] + corners[2, 0] - corners[1, 0])
    by = 0.5 * (corners[3, 1] - corners[0, 1] + corners[2, 1] - corners[1, 1])
    if abs(ax) < abs(ay):
        ax, ay, bx, by = bx, by, ax, ay
    most, least = _squeeze(ax / width, ay / width, bx / height, by / height)
    found[LYING], found[MISFIT] = 0.0, 0.0
    if least < 0.7 * most:
        other_most, other_least = _squeeze(ax / height, ay / height, bx / width, by / width)
        if other_least / other_most > least / most + LYING_SHARE:
            most, least = other_most, other_least
            found[LYING] = 1.0
    found[SCALE] = most
    found[TURN_AWAY] = math.acos(min(least / most, 1.0))
    across, along = math.hypot(ax, ay) / width, math.hypot(bx, by) / height
    if across > along and found[LYING] == 0.0:
        # a robot sees a board from the side more often than from far above
        found[MISFIT] = max(math.log(across / along) - ABOVE, 0.0)


@njit(cache=True, nogil=True)
def cut_outline(
    box: NDArray[np.float64],
    kind_is_round: bool,
    width: float,
    height: float,
    cut: int,
    found: NDArray[np.float64],
) -> None:
    """The same of a shape of which the picture's border leaves a part: what is seen is a bound."""
    across, along = box[4] / width, box[5] / height
    found[LYING], found[TURN_AWAY], found[MISFIT] = 0.0, 0.0, 0.0
    found[SCALE] = max(across, along)
    if kind_is_round:
        found[MISFIT] = _cylinder_tilt(box[5] / box[4], height / width, cut)[0]
        if cut == CUT_ALONG:
            found[SCALE] = across
    elif cut == CUT_ACROSS:
        found[MISFIT] = max(math.log(across / along) - ABOVE, 0.0)
    elif cut == CUT_ALONG:
        found[MISFIT] = max(math.log(along / across) - ASIDE, 0.0)
    found[SHOWN] = min(across * along / found[SCALE] ** 2, 1.0)
