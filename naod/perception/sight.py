"""From a YUYV picture to the object's box in one compiled call."""

from __future__ import annotations

import sys

import numpy as np
from numba import njit
from numpy.typing import NDArray

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
from naod.perception.components import pad
from naod.perception.lookup import NEED_BITS, NEED_MASK
from naod.perception.memory import LINE, Memory, int32s, uint8s, uint32s, zeroed
from naod.perception.optimum import solve
from naod.perception.optimum_field import WAVES, Field, bytes_of_field, clear, field_in
from naod.perception.quantising import (
    Picture,
    bytes_of_picture,
    cells_of_row,
    picture_in,
)
from naod.perception.runs import AREA, EVIDENCE, Runs, bytes_of_runs, find_runs, runs_in


@njit(cache=True, nogil=True)
def _result_in(
    memory: Memory, height: int, width: int
) -> tuple[NDArray[np.uint8], NDArray[np.int32], Found, Runs]:
    """Labels (h, w), differences (h, w), box and all regions."""
    mask, at = uint8s(memory, 0, height * width)
    differences, at = int32s(memory, at, height * width)
    found, at = found_in(memory, at, height, width)
    runs, at = runs_in(memory, at, height, width)
    shape = (height, width)
    return mask.reshape(shape), differences.reshape(shape), found, runs


class Sight:
    """What is made of one picture: the memory that a Segmentation and its Blob lie in.

    `mask` (h, w) uint8, `differences` (h, w) int32, `found`: box of the object among the regions
    that have `pixels_min`; `pixels` it has, 0 if there is none, `points` of its boundary, and the
    sides of the picture that cut it. `runs`: the first `run_count` of them make up the mask, and so
    many `regions` are in their table.
    """

    def __init__(self, height: int, width: int, pixels_min: int) -> None:
        size = 5 * height * width + bytes_of_found(height, width) + bytes_of_runs(height, width)
        self.memory = zeroed(size + 2 * LINE)
        self.mask, self.differences, self.found, self.runs = _result_in(self.memory, height, width)
        self.pixels_min = pixels_min
        self.pixels = self.points = self.cut = self.run_count = self.regions = 0

    def holders(self) -> int:
        """References to this memory, its own included."""
        found = self.found
        count = sys.getrefcount(self) + sys.getrefcount(self.mask)
        count += sys.getrefcount(self.differences) + sys.getrefcount(found.corners)
        count += sys.getrefcount(found.centre) + sys.getrefcount(found.boundary)
        return count + sys.getrefcount(self.runs)


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

    def _fresh(self) -> Sight:
        return Sight(*self._shape, self._pixels_min)


@njit(cache=True, nogil=True)
def _scratch_in(
    memory: Memory, found: Found, height: int, width: int
) -> tuple[Field, Box, NDArray[np.uint32], int]:
    field, at = field_in(memory, 0, height, width)
    box, at = box_in(memory, at, found, height, width)
    places, at = uint32s(memory, at, height * width)
    return field, box, places.reshape((height, width)), at


def scratch(height: int, width: int, picture_width: int) -> Memory:
    """Memory that pictures of one size are worked on in."""
    size = bytes_of_field(height, width) + bytes_of_box(height, width)
    size += bytes_of_picture(picture_width)
    memory = zeroed(size + 4 * height * width + LINE)
    clear(field_in(memory, 0, height, width)[0])
    return memory


@njit(cache=True, nogil=True)
def _measure_pixels(
    picture: Picture,
    kind: int,
    block: int,
    entries: NDArray[np.int32],
    places: NDArray[np.uint32],
    field: Field,
    differences: NDArray[np.int32],
) -> None:
    """Differences (h, w) of all blocks, and the needs of a field's cells."""
    # the whole picture first: looking up in between would keep memory waiting
    for i in range(places.shape[0]):
        cells_of_row(picture, kind, block, i, places[i])
    for i in range(places.shape[0]):
        line, needs, here = differences[i], field.needs[i + 1], places[i]
        for j in range(line.size):
            line[j] = entries[here[j]]
        for j in range(line.size):
            needs[j] = np.uint8(line[j] & NEED_MASK)
        for j in range(line.size):
            line[j] >>= NEED_BITS


@njit(cache=True, nogil=True)
def _choose(
    field: Field,
    differences: NDArray[np.int32],
    runs: Runs,
    box: Box,
    pixels_min: int,
    grain_px: float,
) -> tuple[int, int, int, int, int]:
    """The box of the region of least difference; its pixels, boundary points and cut sides.

    No pixels: there is no region of `pixels_min`. Then how many runs and regions there are.
    """
    count, regions = find_runs(field.rows, field.words, field.hot, differences, runs)
    chosen, most = 0, -1
    for name in range(1, regions + 1):
        line = runs.table[name]
        if line[AREA] >= pixels_min and line[EVIDENCE] > most:
            chosen, most = name, line[EVIDENCE]
    if chosen == 0:
        return 0, 0, 0, count, regions
    breaks_of_region(runs, count, chosen, box)
    height, width = differences.shape
    extent = runs.table[chosen]
    points, cut = measure_box(box, extent, height, width, grain_px)
    return extent[AREA], points, cut, count, regions


@njit(cache=True, nogil=True)
def measure(
    raw: NDArray[np.uint8],
    kind: int,
    block: int,
    entries: NDArray[np.int32],
    memory: Memory,
    result: Memory,
    height: int,
    width: int,
) -> None:
    """Differences of a picture's blocks."""
    _, differences, found, _ = _result_in(result, height, width)
    field, _, places, at = _scratch_in(memory, found, height, width)
    picture = picture_in(memory, at, raw, kind)[0]
    _measure_pixels(picture, kind, block, entries, places, field, differences)


@njit(cache=True, nogil=True)
def choose_in_mask(
    memory: Memory, result: Memory, height: int, width: int, pixels_min: int, grain_px: float
) -> tuple[int, int, int, int, int]:
    """As `see`, of labels that another optimiser wrote."""
    mask, differences, found, runs = _result_in(result, height, width)
    field, box, _, _ = _scratch_in(memory, found, height, width)
    pad(mask, field.rows, field.hot)
    return _choose(field, differences, runs, box, pixels_min, grain_px)


@njit(cache=True, nogil=True)
def see(
    raw: NDArray[np.uint8],
    kind: int,
    block: int,
    entries: NDArray[np.int32],
    memory: Memory,
    result: Memory,
    height: int,
    width: int,
    beta: int,
    pixels_min: int,
) -> tuple[int, int, int, int, int, int, int]:
    """All of it: differences, the exact optimum, the object's box.

    `raw`: the picture's bytes (H, 2 W). `kind`, `block`: how it is reduced to (height, width).
    `memory`: of `scratch`. `result`: a Sight's. Returns the energy, waves of the cut, pixels,
    boundary points and cut sides of the object, runs and regions of the mask; no pixels: no region
    has `pixels_min`.
    """
    mask, differences, found, runs = _result_in(result, height, width)
    field, box, places, at = _scratch_in(memory, found, height, width)
    picture = picture_in(memory, at, raw, kind)[0]
    _measure_pixels(picture, kind, block, entries, places, field, differences)
    energy = solve(field, differences, beta, mask)
    pixels, points, cut, count, regions = _choose(
        field, differences, runs, box, pixels_min, float(block)
    )
    return energy, field.counts[WAVES], pixels, points, cut, count, regions
