"""The minimum cut through the cells that the bounds leave open, by waves of pushes.

A cell's excess is what it would cost to make it object, its decided neighbours counted; a negative
one is a need. Excess flows to needs from open cell to open neighbour, beta at most either way. Each
wave finds the steps from every cell to the nearest need it can still reach and lets all excess flow
downhill, farthest first; then some of what got stuck is lifted cell by cell. What cannot reach a
need is background, for good. Once no excess reaches one, what does is object: the least of all
minima. Steps to a need never get fewer, and every wave lengthens some or drops a cell, so n cells
take n^2 waves at the very most; noise at its worst took a few dozen.
Max-flow by preflow: Goldberg and Tarjan 1988, distances made exact in every round.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from naod.perception.optimum_field import (
    BACKGROUND,
    LIFTS,
    OBJECT,
    OPEN,
    VISITS,
    WAVES,
    Field,
    neighbourhood,
    sides,
)

_UNSEEN = np.int32(-1)
_NOWHERE = np.int32(1 << 30)
_LIFTS_SHARE, _LIFTS_MIN = 4, 4
"""A wave costs a visit to every cell, a lift one visit: so many cells for one lift, and a few."""


@njit(cache=True, nogil=True)
def _component(field: Field, beta: int, seed: np.uint64) -> int:
    """List the open cells connected to `seed`, their excess and capacities; their number."""
    nodes, level, steps = field.nodes, field.level, sides(field)
    nodes[0] = seed
    level[seed] = _UNSEEN
    count, k = 1, 0
    while k < count:
        cell = np.uint64(nodes[k])
        k += 1
        near = neighbourhood(field, cell)
        # half-way between the bounds an open neighbour weighs on neither side
        balance = 4 - ((near & 15) + (near >> 4)) // 2
        field.excess[cell] = field.differences[cell] + beta * balance
        for side in range(4):
            other = cell + steps[side]
            inside = field.codes[other] == OPEN
            field.residual[cell, side] = beta if inside else 0
            if inside and level[other] == 0:
                level[other] = _UNSEEN
                nodes[count] = other
                count += 1
    return count


@njit(cache=True, nogil=True)
def _needs(field: Field, count: int) -> int:
    """Queue the nodes in need, at level 1, and put all others out of sight; how many need."""
    needs = 0
    for k in range(count):
        cell = np.uint64(field.nodes[k])
        need = field.excess[cell] < 0
        field.level[cell] = np.int32(1) if need else _UNSEEN
        field.queue[needs] = cell
        needs += need
    return needs


@njit(cache=True, nogil=True)
def _climb(field: Field, needs: int) -> tuple[int, bool]:
    """Queue and level all that reaches a need; how many do, and whether any has excess."""
    queue, level, residual, steps = field.queue, field.level, field.residual, sides(field)
    count, k = needs, 0
    while k < count:
        cell = np.uint64(queue[k])
        k += 1
        above = np.int32(level[cell] + 1)
        for side in range(4):
            other = cell + steps[side]
            now = level[other]
            new = (now < 0) & (residual[other, side ^ 1] > 0)
            level[other] = above if new else now
            queue[count] = other
            count += new
    flows = False
    for k in range(needs, count):
        flows |= field.excess[np.uint64(queue[k])] > 0
    return count, flows


@njit(cache=True, nogil=True)
def _settle(field: Field, count: int, flows: bool) -> None:
    """Nodes out of reach are background; the rest is object, unless something still flows."""
    for k in range(count):
        cell = np.uint64(field.nodes[k])
        unseen = field.level[cell] < 0
        if unseen or not flows:
            field.codes[cell] = BACKGROUND if unseen else OBJECT
            field.level[cell] = 0


@njit(cache=True, nogil=True)
def _flow(field: Field, count: int) -> int:
    """Push all excess down by one level, farthest cells first; how many are stuck, in `pending`."""
    excess, level, residual, steps = field.excess, field.level, field.residual, sides(field)
    stuck = 0
    for k in range(count - 1, -1, -1):
        cell = np.uint64(field.queue[k])
        rest = excess[cell]
        if rest <= 0:
            continue
        # nothing is below a need that has been filled: level 0 is where cells have been dropped
        below = level[cell] - 1 if level[cell] > 1 else _NOWHERE
        for side in range(4):
            other = cell + steps[side]
            amount = np.int32(min(rest, residual[cell, side]) if level[other] == below else 0)
            residual[cell, side] -= amount
            residual[other, side ^ 1] += amount
            excess[other] += amount
            rest = np.int32(rest - amount)
        excess[cell] = rest
        field.pending[stuck] = cell
        stuck += rest > 0
    return stuck


@njit(cache=True, nogil=True)
def _lowest(field: Field, cell: np.uint64) -> np.int32:
    """Level of the lowest neighbour that a cell can still push to, or _NOWHERE."""
    steps = sides(field)
    lowest = _NOWHERE
    for side in range(4):
        at = field.level[cell + steps[side]]
        if field.residual[cell, side] > 0 and at > 0:
            lowest = min(lowest, at)
    return lowest


@njit(cache=True, nogil=True)
def _lift(field: Field, stuck: int, lifts: int) -> int:
    """Lift stuck cells above their lowest neighbour and push on, `lifts` times; how often left."""
    excess, residual, steps = field.excess, field.residual, sides(field)
    while stuck > 0 and lifts > 0:
        stuck -= 1
        lifts -= 1
        cell = np.uint64(field.pending[stuck])
        lowest = _lowest(field, cell)
        if lowest == _NOWHERE:
            continue
        field.level[cell] = lowest + 1
        rest = excess[cell]
        for side in range(4):
            other = cell + steps[side]
            if field.level[other] != lowest:
                continue
            amount = min(rest, residual[cell, side])
            residual[cell, side] -= amount
            residual[other, side ^ 1] += amount
            before = excess[other]
            excess[other] = before + amount
            rest = np.int32(rest - amount)
            field.pending[stuck] = other
            stuck += (before <= 0) & (before + amount > 0)
        excess[cell] = rest
        field.pending[stuck] = cell
        stuck += rest > 0
    return lifts


@njit(cache=True, nogil=True)
def _cut_component(field: Field, count: int) -> None:
    while True:
        reached, flows = _climb(field, _needs(field, count))
        field.counts[WAVES] += 1
        field.counts[VISITS] += count
        if reached < count or not flows:
            _settle(field, count, flows)
        if not flows:
            return
        lifts = reached // _LIFTS_SHARE + _LIFTS_MIN
        field.counts[LIFTS] += lifts - _lift(field, _flow(field, reached), lifts)
        count = reached
        field.nodes[:count] = field.queue[:count]


@njit(cache=True, nogil=True)
def cut(field: Field, beta: int, candidates: int) -> None:
    """Decide all open cells, which are the first `candidates`, component by component."""
    field.counts[WAVES] = field.counts[VISITS] = field.counts[LIFTS] = 0
    for k in range(candidates):
        cell = np.uint64(field.candidates[k])
        if field.codes[cell] == OPEN:
            _cut_component(field, _component(field, beta, cell))
