"""The exact minimum of the two-label Potts energy (equation 3), which is a minimum cut.

Greig, Porteous and Seheult 1989. Most pixels never get near the cut: their own difference decides,
or the bounds of `optimum_bracket` do.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.bits import WORD, ones, unpack, words_of
from naod.perception.memory import Memory, views_of, zeroed
from naod.perception.optimum_bracket import bracket, take_decided, take_row
from naod.perception.optimum_cut import cut
from naod.perception.optimum_field import WAVES, Field, bytes_of_field, clear, field_in, votes_of

BETA_MAX = 1 << 27
"""Twelve times as much, the most that a cell of the cut can hold, is still an int32."""

_U0, _U1, _U63 = (np.uint64(n) for n in (0, 1, 63))


@njit(cache=True, nogil=True)
def broken_pairs(bits: NDArray[np.uint64], height: int, width: int) -> int:
    """Neighbours of different label; `bits` begin with the first row's."""
    words, broken = words_of(width), _U0
    # beyond the last column there is nothing to differ from
    inner = ~(_U1 << np.uint64((width - 1) % WORD))
    for row in range(height):
        for n in range(words - 1):
            k = row * words + n
            change = bits[k] ^ (bits[k] >> _U1 | bits[k + 1] << _U63)
            broken += ones(change & inner if n == words - 2 else change)
    for k in range((height - 1) * words):
        broken += ones(bits[k] ^ bits[k + words])
    return int(broken)


@njit(cache=True, nogil=True)
def solve(field: Field, values: NDArray[np.int32], places: NDArray[np.uint32], beta: int) -> None:
    """The minimum from the planes, as bits in `field.least`.

    values[places[i, j]] is the difference of pixel (i, j).
    """
    cut(field, beta, bracket(field, values, places))
    take_decided(field, *places.shape)


@njit(cache=True, nogil=True)
def _minimise(
    memory: Memory,
    differences: NDArray[np.int32],
    places: NDArray[np.uint32],
    beta: int,
    labels: NDArray[np.uint8],
) -> int:
    height, width = labels.shape
    field, _ = field_in(memory, 0, height, width)
    for i in range(height):
        votes_of(differences[i], np.int32(beta), field.votes)
        take_row(field.votes, field.eights, field.plane_bytes, i, height, width)
    solve(field, differences.reshape(-1), places, beta)
    bits = field.least[words_of(width) :]
    unpack(bits, labels)
    own = 0
    for i in range(height):
        for j in range(width):
            own += differences[i, j] if labels[i, j] else 0
    return own + beta * broken_pairs(bits, height, width)


class Optimum:
    """Minimises fields of one size; all memory is taken at the start.

    Of several minima it gives the least: the object has no pixel that it has not in all of them.
    """

    def __init__(self, height: int, width: int) -> None:
        self.shape = (height, width)
        self._memory = zeroed(bytes_of_field(height, width))
        field, _ = field_in(self._memory, 0, height, width)
        clear(field)
        (self._counts,) = views_of(self._memory, [field.counts])
        self._places = np.arange(height * width, dtype=np.uint32).reshape(height, width)

    @property
    def counts(self) -> NDArray[np.int64]:
        """Work done by the last call, (5,): CANDIDATES, UNDECIDED, WAVES, VISITS, LIFTS."""
        return self._counts

    @property
    def waves(self) -> int:
        """Waves of the cut in the last call; 0 when the bounds met everywhere."""
        return int(self._counts[WAVES])

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
        return int(_minimise(self._memory, differences, self._places, beta, labels))
