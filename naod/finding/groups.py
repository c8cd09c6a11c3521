"""Which regions of a mask may belong together: single ones, and those near each other."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.components import AREA, BOTTOM, LEFT, RIGHT, TOP

REGIONS_MAX = 12
"""Regions looked at, those with most of the object's colour."""

GROUPS_MAX = 32
PARTS_MAX = 5
SPECK_PIXELS = 4
"""Regions below this are no part of anything."""

REACH = 0.45
"""How far apart two parts may lie, of the larger one's longer side."""

FILL_MIN = 0.3
"""Less than this share of the box around a group is no wrapper with a ribbon."""

ALIKE_LEVELS = 16.0
"""8-bit levels of Y, U and V together by which parts of one thing may differ."""

NO_COLOURS: NDArray[np.float64] = np.zeros((0, 3))


@njit(cache=True, nogil=True)
def _near(table: NDArray[np.int64], a: int, b: int) -> bool:
    across = max(table[a, LEFT] - table[b, RIGHT], table[b, LEFT] - table[a, RIGHT])
    along = max(table[a, TOP] - table[b, BOTTOM], table[b, TOP] - table[a, BOTTOM])
    longest = 0
    for k in (a, b):
        longest = max(longest, table[k, RIGHT] - table[k, LEFT] + 1)
        longest = max(longest, table[k, BOTTOM] - table[k, TOP] + 1)
    return max(across, along) - 1 <= max(REACH * longest, 2.0)


@njit(cache=True, nogil=True)
def _dense(table: NDArray[np.int64], chosen: NDArray[np.int64], members: int) -> bool:
    left, right, top, bottom, area = 1 << 30, -1, 1 << 30, -1, 0
    for n in range(len(chosen)):
        if members >> n & 1:
            k = chosen[n]
            left, right = min(left, table[k, LEFT]), max(right, table[k, RIGHT])
            top, bottom = min(top, table[k, TOP]), max(bottom, table[k, BOTTOM])
            area += table[k, AREA]
    return area >= FILL_MIN * (right - left + 1) * (bottom - top + 1)


@njit(cache=True, nogil=True)
def _most_evident(
    table: NDArray[np.int64], evidence: NDArray[np.float64], least: int
) -> NDArray[np.int64]:
    """Rows of the regions of at least so many pixels, most evidence first."""
    order = np.argsort(-evidence)
    kept = np.empty(min(len(order), REGIONS_MAX), dtype=np.int64)
    count = 0
    for k in order:
        if table[k, AREA] >= least and evidence[k] > 0.0 and count < len(kept):
            kept[count] = k
            count += 1
    return kept[:count]


@njit(cache=True, nogil=True)
def _bits(members: int) -> int:
    count = 0
    while members:
        members &= members - 1
        count += 1
    return count


@njit(cache=True, nogil=True)
def _alike(colours: NDArray[np.float64], a: int, b: int) -> bool:
    if not len(colours):
        return True
    gap2 = 0.0
    for c in range(3):
        gap2 += (colours[a, c] - colours[b, c]) ** 2
    return gap2 < ALIKE_LEVELS**2


@njit(cache=True, nogil=True)
def _joins(
    table: NDArray[np.int64],
    colours: NDArray[np.float64],
    chosen: NDArray[np.int64],
    members: int,
    n: int,
) -> bool:
    joined = False
    for m in range(len(chosen)):
        if members >> m & 1:
            if not _alike(colours, chosen[m], chosen[n]):
                return False
            joined |= _near(table, chosen[m], chosen[n])
    return joined


@njit(cache=True, nogil=True)
def groups_of(
    table: NDArray[np.int64],
    evidence: NDArray[np.float64],
    pixels_min: int,
    together: bool,
    colours: NDArray[np.float64],
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows of `table` that are looked at (n,), and groups of them as bits (m,), at most GROUPS_MAX.

    evidence: (n,) of each region, for the object. A group has at least `pixels_min` pixels in its
    largest part. Without `together` they are single regions. colours: (n, 3) mean Y, U and V, which
    may not differ much in a group, or NO_COLOURS.
    """
    chosen = _most_evident(table, evidence, min(SPECK_PIXELS, pixels_min))
    groups = np.empty(GROUPS_MAX, dtype=np.int64)
    count = 0
    for n in range(len(chosen)):
        if table[chosen[n], AREA] >= pixels_min:
            groups[count] = 1 << n
            count += 1
    done = 0
    while together and done < count:
        members = groups[done]
        done += 1
        if _bits(members) == PARTS_MAX:
            continue
        for n in range(len(chosen)):
            wider = members | 1 << n
            if count == GROUPS_MAX or wider == members or wider in groups[:count]:
                continue
            if _joins(table, colours, chosen, members, n) and _dense(table, chosen, wider):
                groups[count] = wider
                count += 1
    return chosen, groups[:count].copy()
