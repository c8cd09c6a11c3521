"""The exact minimum of the two-label Potts energy (equation 3), which is a minimum cut.

Greig, Porteous and Seheult 1989. Most pixels never get near the cut: their own difference decides,
or the bounds of `optimum_bracket` do. Rows that are background altogether are not looked at again.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.optimum_bracket import bracket
from naod.perception.optimum_cut import cut
from naod.perception.optimum_field import WAVES, Field, empty_field, needs_of

BETA_MAX = 1 << 27
"""Twelve times as much, the most that a cell of the cut can hold, is still an int32."""


@njit(cache=True, nogil=True)
def _write_row(
    codes: NDArray[np.uint8], differences: NDArray[np.int32], row: NDArray[np.uint8]
) -> tuple[int, int]:
    """Labels of one row; the sum of the object's differences, and labels that change in it."""
    total = broken = 0
    for j in range(row.size):
        row[j] = codes[j] >> 1 & 1
    for j in range(row.size):
        total += differences[j] if row[j] else 0
    for j in range(row.size - 1):
        broken += row[j] != row[j + 1]
    return total, broken


@njit(cache=True, nogil=True)
def _changes(codes: NDArray[np.uint8], below: NDArray[np.uint8], width: int) -> int:
    broken = 0
    for j in range(width):
        broken += codes[j] != below[j]
    return broken


@njit(cache=True, nogil=True)
def _write(
    field: Field, differences: NDArray[np.int32], beta: int, labels: NDArray[np.uint8]
) -> int:
    """Labels of decided codes, and their energy above the all-background field."""
    height, width = labels.shape
    total = broken = 0
    for i in range(height):
        hot = field.hot[i + 1]
        if hot:
            own, across = _write_row(field.rows[i + 1], differences[i], labels[i])
            total += own
            broken += across
        else:
            labels[i] = 0
        if i + 1 < height and (hot or field.hot[i + 2]):
            broken += _changes(field.rows[i + 1], field.rows[i + 2], width)
    return total + beta * broken


@njit(cache=True, nogil=True)
def solve(
    field: Field, differences: NDArray[np.int32], beta: int, labels: NDArray[np.uint8]
) -> int:
    """The minimum from the needs; its energy."""
    cut(field, beta, bracket(field, differences))
    return _write(field, differences, beta, labels)


@njit(cache=True, nogil=True)
def _minimise(
    field: Field, differences: NDArray[np.int32], beta: int, labels: NDArray[np.uint8]
) -> int:
    for i in range(labels.shape[0]):
        needs_of(differences[i], np.int32(beta), field.needs[i + 1])
    return solve(field, differences, beta, labels)


class Optimum:
    """Minimises fields of one size; all memory is taken at the start.

    Of several minima it gives the least: the object has no pixel that it has not in all of them.
    """

    def __init__(self, height: int, width: int) -> None:
        self.shape = (height, width)
        self._field = empty_field(height, width)

    @property
    def counts(self) -> NDArray[np.int64]:
        """Work done by the last call, (5,): CANDIDATES, UNDECIDED, WAVES, VISITS, LIFTS."""
        return self._field.counts

    @property
    def waves(self) -> int:
        """Waves of the cut in the last call; 0 when the bounds met everywhere."""
        return int(self._field.counts[WAVES])

    def minimise(self, differences: NDArray[np.int32], beta: int, labels: NDArray[np.uint8]) -> int:
        """Write the minimum for (h, w) int32 into (h, w) uint8, 1 = object.

        Differences are the object's singleton energies less the background's; `beta`, in the same
        steps, is 0 to BETA_MAX. Returns the energy above that of the all-background field. Raises
        ValueError for another shape, type, layout or beta.
        """
        if differences.shape != self.shape or labels.shape != self.shape:
            raise ValueError(f"expected fields {self.shape}, got {differences.shape}")
        if differences.dtype != np.int32 or labels.dtype != np.uint8:
            raise ValueError(f"expected int32 and uint8, got {differences.dtype}, {labels.dtype}")
        if not (differences.flags.c_contiguous and labels.flags.c_contiguous):
            # another layout would compile everything once more
            raise ValueError("expected contiguous fields")
        if not 0 <= beta <= BETA_MAX:
            raise ValueError(f"beta {beta}: 0 to {BETA_MAX} steps")
        return int(_minimise(self._field, differences, beta, labels))
