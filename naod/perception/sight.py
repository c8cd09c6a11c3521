"""From a YUYV picture to the object's box in one compiled call."""

from __future__ import annotations

import sys

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.bits import pack, unpack, words_of
from naod.perception.box import (
    Box,
    Found,
    box_in,
    breaks_of_region,
    bytes_of_box,
    bytes_of_found,
    found_in,
    measure_box,
)
from naod.perception.memory import LINE, Memory, int32s, uint8s, uint32s, zeroed
from naod.perception.optimum import broken_pairs, solve
from naod.perception.optimum_bracket import take_row
from naod.perception.optimum_field import (
    CELLS_A_WORD,
    WAVES,
    Field,
    bytes_of_field,
    clear,
    field_in,
)
from naod.perception.quantising import (
    Picture,
    bytes_of_picture,
    cells_of_row,
    picture_in,
)
from naod.perception.runs import AREA, EVIDENCE, Runs, bytes_of_runs, find_runs, runs_in, weigh


@njit(cache=True, nogil=True)
def _result_in(
    memory: Memory, height: int, width: int
) -> tuple[NDArray[np.uint8], NDArray[np.int32], NDArray[np.uint32], Found, Runs]:
    """Labels (h, w), differences (h, w), places in the lookup (h, w), box and all regions."""
    mask, at = uint8s(memory, 0, height * width)
    differences, at = int32s(memory, at, height * width)
    places, at = uint32s(memory, at, height * width)
    found, at = found_in(memory, at, height, width)
    runs, at = runs_in(memory, at, height, width)
    shape = (height, width)
    return mask.reshape(shape), differences.reshape(shape), places.reshape(shape), found, runs


@njit(cache=True, nogil=True)
def _fill(
    values: NDArray[np.int32], places: NDArray[np.uint32], differences: NDArray[np.int32]
) -> None:
    for i in range(places.shape[0]):
        here, out = places[i], differences[i]
        for j in range(here.size):
            out[j] = values[here[j]]


class Sight:
    """What is made of one picture: the memory that a Segmentation and its Blob lie in.

    `mask` (h, w) uint8; `found`: box of the object among the regions that have `pixels_min`;
    `pixels` it has, 0 if there is none, `points` of its boundary, and the sides of the picture that
    cut it. `runs`: the first `run_count` of them make up the mask, and so many `regions` are in
    their table. `values`: the lookup that `differences` come from, None once they are there.
    """

    def __init__(self, height: int, width: int, pixels_min: int) -> None:
        size = 9 * height * width + bytes_of_found(height, width) + bytes_of_runs(height, width)
        self.memory = zeroed(size + 3 * LINE)
        parts = _result_in(self.memory, height, width)
        self.mask, self._differences, self._places, self.found, self.runs = parts
        # what others may hold
        self._parts = (self.mask, self._differences, *self.found, self.runs)
        self.values: NDArray[np.int32] | None = None
        self.pixels_min = pixels_min
        self.pixels = self.points = self.cut = self.run_count = self.regions = 0

    @property
    def differences(self) -> NDArray[np.int32]:
        """(h, w) int32 of all pixels, looked up when somebody asks: few do."""
        if self.values is not None:
            _fill(self.values, self._places, self._differences)
            self.values = None
        return self._differences

    def holders(self) -> int:
        """References to this memory, its own included."""
        return sys.getrefcount(self) + sum(map(sys.getrefcount, self._parts))


class Sights:
    """Memory for results, used again as soon as nobody holds anything of it.

    Whoever drops a result before asking for the next but one makes it run in what was taken at the
    start; whoever keeps results keeps them unchanged, and more is taken.
    """

    def __init__(self, height: int, width: int, pixels_min: int) -> None:
        self._shape = (height, width)
        self._pixels_min = pixels_min
        self._all = [self._fresh(), self._fresh()]
        # how many a sight has that nobody holds, counted as `take` counts
        self._unheld = next(sight.holders() for sight in self._all)
        self._next = 0

    def take(self) -> Sight:
        """Memory that nobody holds anything of."""
        for _ in range(len(self._all)):
            self._next = (self._next + 1) % len(self._all)
            sight = self._all[self._next]
            if sight.holders() == self._unheld:
                return sight
        self._all.append(self._fresh())
        self._next = len(self._all) - 1
        return self._all[-1]

    def look_up(self) -> None:
        """Fill in all differences while the lookup that they come from is still there."""
        for sight in self._all:
            _ = sight.differences

    def _fresh(self) -> Sight:
        return Sight(*self._shape, self._pixels_min)


@njit(cache=True, nogil=True)
def _scratch_in(memory: Memory, found: Found, height: int, width: int) -> tuple[Field, Box, int]:
    field, at = field_in(memory, 0, height, width)
    box, at = box_in(memory, at, found, height, width)
    return field, box, at


def scratch(height: int, width: int, picture_width: int) -> Memory:
    """Memory that pictures of one size are worked on in."""
    size = bytes_of_field(height, width) + bytes_of_box(height, width)
    memory = zeroed(size + bytes_of_picture(picture_width) + LINE)
    clear(field_in(memory, 0, height, width)[0])
    return memory


@njit(cache=True, nogil=True)
def _measure_pixels(
    picture: Picture,
    kind: int,
    block: int,
    votes: NDArray[np.uint8],
    places: NDArray[np.uint32],
    field: Field,
) -> None:
    """Places (h, w) of all blocks in the lookup, and the planes of a field from their votes."""
    height, width = places.shape
    whole, own, eights, planes = width // CELLS_A_WORD, field.votes, field.eights, field.plane_bytes
    for i in range(height):
        here = places[i]
        cells_of_row(picture, kind, block, i, here)
        for k in range(whole):
            eights[k] = _eight(votes, here[CELLS_A_WORD * k : CELLS_A_WORD * (k + 1)])
        for j in range(CELLS_A_WORD * whole, width):
            own[j] = votes[here[j]]
        take_row(own, eights, planes, i, height, width)


@njit(cache=True, nogil=True)
def _eight(votes: NDArray[np.uint8], here: NDArray[np.uint32]) -> np.uint64:
    """Votes of eight pixels as the bytes of a word: one store for eight."""
    word = np.uint64(0)
    for n in range(CELLS_A_WORD):
        word |= np.uint64(votes[here[n]]) << np.uint64(8 * n)
    return word


@njit(cache=True, nogil=True)
def _choose(
    bits: NDArray[np.uint64],
    values: NDArray[np.int32],
    places: NDArray[np.uint32],
    runs: Runs,
    box: Box,
    pixels_min: int,
    grain_px: float,
) -> tuple[int, int, int, int, int, int]:
    """The box of the region of least difference.

    Differences of all regions added up; then the chosen one's pixels, 0 if none has `pixels_min`,
    boundary points and cut sides; then how many runs and regions there are.
    """
    height, width = places.shape
    count, regions = find_runs(bits, height, width, runs)
    cost = weigh(runs, count, values, places)
    chosen, most = 0, -1
    for name in range(1, regions + 1):
        line = runs.table[name]
        if line[AREA] >= pixels_min and line[EVIDENCE] > most:
            chosen, most = name, line[EVIDENCE]
    if chosen == 0:
        return cost, 0, 0, 0, count, regions
    breaks_of_region(runs, count, chosen, box)
    extent = runs.table[chosen]
    points, cut = measure_box(box, extent, height, width, grain_px)
    return cost, extent[AREA], points, cut, count, regions


@njit(cache=True, nogil=True)
def measure(
    raw: NDArray[np.uint8],
    kind: int,
    block: int,
    values: NDArray[np.int32],
    memory: Memory,
    result: Memory,
    height: int,
    width: int,
) -> None:
    """Differences of a picture's blocks."""
    _, differences, places, found, _ = _result_in(result, height, width)
    _, _, at = _scratch_in(memory, found, height, width)
    picture = picture_in(memory, at, raw, kind)[0]
    for i in range(height):
        cells_of_row(picture, kind, block, i, places[i])
    _fill(values, places, differences)


@njit(cache=True, nogil=True)
def choose_in_mask(
    values: NDArray[np.int32],
    memory: Memory,
    result: Memory,
    height: int,
    width: int,
    pixels_min: int,
    grain_px: float,
) -> tuple[int, int, int, int, int]:
    """As `see`, of labels that another optimiser wrote."""
    mask, _, places, found, runs = _result_in(result, height, width)
    field, box, _ = _scratch_in(memory, found, height, width)
    words = words_of(width)
    bits = field.least[words : (height + 1) * words]
    pack(mask, bits)
    return _choose(bits, values, places, runs, box, pixels_min, grain_px)[1:]


@njit(cache=True, nogil=True)
def see(
    raw: NDArray[np.uint8],
    kind: int,
    block: int,
    votes: NDArray[np.uint8],
    values: NDArray[np.int32],
    memory: Memory,
    result: Memory,
    height: int,
    width: int,
    beta: int,
    pixels_min: int,
) -> tuple[int, int, int, int, int, int, int]:
    """All of it: places, the exact optimum, the object's box.

    `raw`: the picture's bytes (H, 2 W). `kind`, `block`: how it is reduced to (height, width).
    `votes`, `values`: of a Lookup. `memory`: of `scratch`. `result`: a Sight's. Returns the energy,
    waves of the cut, pixels, boundary points and cut sides of the object, runs and regions of the
    mask; no pixels: no region has `pixels_min`.
    """
    mask, _, places, found, runs = _result_in(result, height, width)
    field, box, at = _scratch_in(memory, found, height, width)
    picture = picture_in(memory, at, raw, kind)[0]
    _measure_pixels(picture, kind, block, votes, places, field)
    solve(field, values, places, beta)
    bits = field.least[words_of(width) :]
    unpack(bits, mask)
    cost, pixels, points, cut, count, regions = _choose(
        bits, values, places, runs, box, pixels_min, float(block)
    )
    energy = cost + beta * broken_pairs(bits, height, width)
    return energy, field.counts[WAVES], pixels, points, cut, count, regions
