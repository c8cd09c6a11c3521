"""Connected regions of a mask from its runs: stretches of touching pixels within a row.

A row is sixty-four pixels a word, and only words in which something changes are looked into.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.bits import WORD, trailing_zeros, words_of
from naod.perception.memory import LINE, Memory, int32s, int64s

AREA, LEFT, RIGHT, TOP, BOTTOM, SUM_X, SUM_Y, EVIDENCE = range(8)
"""Columns of the table of regions; EVIDENCE: steps by which its pixels are likelier object."""

_U0, _U1, _U63 = (np.uint64(n) for n in (0, 1, 63))


class Runs(NamedTuple):
    """Runs in the order of rows, and the regions that they make up.

    Run k is row `rows[k]`, columns `starts[k]` to `ends[k]`, in region `names[k]`, which is a line
    of the table; 0 is nobody. Regions count from 1 in the order of their first pixels.
    """

    rows: NDArray[np.int32]  # (runs at most,)
    starts: NDArray[np.int32]
    ends: NDArray[np.int32]
    names: NDArray[np.int32]  # while they are joined, each run's parent among the runs
    table: NDArray[np.int64]  # (regions at most + 1, 8)


@njit(cache=True, nogil=True)
def _at_most(height: int, width: int) -> tuple[int, int]:
    """Runs and lines of the table that a mask of this size can have."""
    across = (width + 1) // 2
    return height * across + 1, ((height + 1) // 2) * across + 1


@njit(cache=True, nogil=True)
def runs_in(memory: Memory, start: int, height: int, width: int) -> tuple[Runs, int]:
    """Room for the runs of any mask of this size, and where memory is free again."""
    most, regions = _at_most(height, width)
    rows, at = int32s(memory, start, most)
    starts, at = int32s(memory, at, most)
    ends, at = int32s(memory, at, most)
    names, at = int32s(memory, at, most)
    table, at = int64s(memory, at, 8 * regions)
    return Runs(rows, starts, ends, names, table.reshape((regions, 8))), at


def bytes_of_runs(height: int, width: int) -> int:
    """Memory that runs take, at the most."""
    return 24 * (height + 1) * (width + 1) + 16 * LINE


@njit(cache=True, nogil=True)
def fresh_runs(height: int, width: int) -> Runs:
    """Memory of their own for the runs of any mask of this size."""
    most, regions = _at_most(height, width)
    return Runs(
        np.empty(most, dtype=np.int32),
        np.empty(most, dtype=np.int32),
        np.empty(most, dtype=np.int32),
        np.empty(most, dtype=np.int32),
        np.empty((regions, 8), dtype=np.int64),
    )


@njit(cache=True, nogil=True)
def _runs_of_row(bits: NDArray[np.uint64], row: int, runs: Runs, count: int) -> int:
    """Append the runs of one row of bits, whose last word is empty."""
    inside, before = False, _U0
    for n in range(bits.size):
        own = bits[n]
        changes = own ^ (own << _U1 | before)
        before = own >> _U63
        while changes != _U0:
            column = WORD * n + np.int64(trailing_zeros(changes))
            changes &= changes - _U1
            inside = not inside
            if inside:
                runs.rows[count], runs.starts[count] = row, column
            else:
                runs.ends[count] = column - 1
                count += 1
    return count


@njit(cache=True, nogil=True)
def _root(parents: NDArray[np.int32], run: int) -> int:
    while parents[run] != run:
        parents[run] = parents[parents[run]]
        run = parents[run]
    return run


@njit(cache=True, nogil=True)
def _join_above(runs: Runs, above: int, first: int, count: int) -> None:
    """Join the runs of a row, `first` to `count`, with those of the row above that they touch."""
    parents, starts, ends = runs.names, runs.starts, runs.ends
    for run in range(first, count):
        parents[run] = run
        while above < first and ends[above] + 1 < starts[run]:
            above += 1
        other = above
        while other < first and starts[other] <= ends[run] + 1:
            a, b = _root(parents, run), _root(parents, other)
            parents[max(a, b)] = min(a, b)
            other += 1


@njit(cache=True, nogil=True)
def _measure(runs: Runs, count: int) -> int:
    """Name the regions and fill their table, all but EVIDENCE; how many there are."""
    regions = 0
    table = runs.table
    for run in range(count):
        parent = runs.names[run]
        row, start, end = runs.rows[run], runs.starts[run], runs.ends[run]
        if parent == run:
            regions += 1
            runs.names[run] = regions
            line = table[regions]
            line[:] = 0
            line[LEFT], line[TOP] = start, row
        else:
            # a parent comes before, so it has its name already
            runs.names[run] = runs.names[parent]
        line = table[runs.names[run]]
        pixels = end - start + 1
        line[AREA] += pixels
        line[LEFT] = min(line[LEFT], start)
        line[RIGHT] = max(line[RIGHT], end)
        line[BOTTOM] = row
        line[SUM_X] += (start + end) * pixels // 2
        line[SUM_Y] += row * pixels
    return regions


@njit(cache=True, nogil=True)
def weigh(runs: Runs, count: int, values: NDArray[np.int32], places: NDArray[np.uint32]) -> int:
    """EVIDENCE of all regions; values[places[i, j]] is the difference of pixel (i, j).

    Returns the differences of all their pixels added up.
    """
    total = 0
    for run in range(count):
        line, here = runs.table[runs.names[run]], places[runs.rows[run]]
        steps = cost = 0
        for j in range(runs.starts[run], runs.ends[run] + 1):
            value = values[here[j]]
            cost += value
            # a pixel that is likelier background counts nothing: the field closed a hole there
            steps -= min(value, np.int32(0))
        line[EVIDENCE] += steps
        total += cost
    return total


@njit(cache=True, nogil=True)
def find_runs(bits: NDArray[np.uint64], height: int, width: int, runs: Runs) -> tuple[int, int]:
    """Runs and regions (eight neighbours) of a mask's bits; how many of each.

    `bits`: rows of `words_of(width)` words, the last one empty.
    """
    above = count = 0
    last = -2
    words = words_of(width)
    for i in range(height):
        row, seen = bits[i * words : (i + 1) * words], _U0
        for n in range(words):
            seen |= row[n]
        if seen == _U0:
            continue
        first = count
        count = _runs_of_row(row, i, runs, count)
        _join_above(runs, above if last == i - 1 else first, first, count)
        above, last = first, i
    return count, _measure(runs, count)


@njit(cache=True, nogil=True)
def paint(runs: Runs, count: int, labels: NDArray[np.int32]) -> None:
    """Write the regions' names into labels (h, w) where their runs are."""
    for run in range(count):
        labels[runs.rows[run], runs.starts[run] : runs.ends[run] + 1] = runs.names[run]
