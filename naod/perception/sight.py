"""From a YUYV picture to the object's box in one compiled call."""

from __future__ import annotations

import sys
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.box import Box, breaks_of_region, empty_box, measure_box
from naod.perception.components import pad
from naod.perception.lookup import NEED_BITS, NEED_MASK
from naod.perception.optimum import solve
from naod.perception.optimum_field import Field
from naod.perception.quantising import Picture, cells_of_row
from naod.perception.runs import AREA, EVIDENCE, Runs, find_runs


class Sight:
    """What is made of one picture: the memory that a Segmentation and its Blob lie in.

    `mask` (h, w) uint8, `differences` (h, w) int32, `box`: of the object among the regions that
    have `pixels_min`; `pixels` it has, 0 if there is none, `points` of its boundary, and the sides
    of the picture that cut it.
    """

    def __init__(self, height: int, width: int, pixels_min: int, scratch: Box) -> None:
        self.mask = np.zeros((height, width), dtype=np.uint8)
        self.differences = np.zeros((height, width), dtype=np.int32)
        fresh = empty_box(1, 1)
        boundary = np.empty_like(scratch.boundary)
        self.box = scratch._replace(corners=fresh.corners, centre=fresh.centre, boundary=boundary)
        self.pixels_min = pixels_min
        self.pixels = self.points = self.cut = 0

    def holders(self) -> int:
        """References to this memory, its own included."""
        box = self.box
        count = sys.getrefcount(self) + sys.getrefcount(self.mask)
        count += sys.getrefcount(self.differences) + sys.getrefcount(box.corners)
        return count + sys.getrefcount(box.centre) + sys.getrefcount(box.boundary)


class Sights:
    """Memory for results, used again as soon as nobody holds anything of it.

    Whoever drops a result before asking for the next but one makes it run in what was taken at the
    start; whoever keeps results keeps them unchanged, and more is taken.
    """

    def __init__(self, height: int, width: int, pixels_min: int) -> None:
        self._shape = (height, width)
        self._pixels_min = pixels_min
        self._scratch = empty_box(height, width)
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
        return Sight(*self._shape, self._pixels_min, self._scratch)


class Layout(NamedTuple):
    """How pictures are cut into blocks: see `quantising`."""

    kind: int
    block: int


@njit(cache=True, nogil=True)
def measure_pixels(
    picture: Picture,
    layout: Layout,
    entries: NDArray[np.int32],
    cells: NDArray[np.uint32],
    field: Field,
    differences: NDArray[np.int32],
) -> None:
    """Differences (h, w) of all blocks, and the needs of a field's cells."""
    width = differences.shape[1]
    for i in range(differences.shape[0]):
        cells_of_row(picture, layout.kind, layout.block, i, cells)
        line, needs = differences[i], field.needs[i + 1]
        for j in range(width):
            line[j] = entries[cells[j]]
        for j in range(width):
            needs[j] = np.uint8(line[j] & NEED_MASK)
        for j in range(width):
            line[j] >>= NEED_BITS


@njit(cache=True, nogil=True)
def choose(
    field: Field,
    differences: NDArray[np.int32],
    runs: Runs,
    box: Box,
    pixels_min: int,
    grain_px: float,
) -> tuple[int, int, int]:
    """The box of the region of least difference; its pixels, boundary points and cut sides.

    No pixels: there is no region of `pixels_min`.
    """
    count, regions = find_runs(field.rows, field.words, field.hot, differences, runs)
    chosen, most = 0, -1
    for name in range(1, regions + 1):
        line = runs.table[name]
        if line[AREA] >= pixels_min and line[EVIDENCE] > most:
            chosen, most = name, line[EVIDENCE]
    if chosen == 0:
        return 0, 0, 0
    breaks_of_region(runs, count, chosen, box)
    height, width = differences.shape
    extent = runs.table[chosen]
    points, cut = measure_box(box, extent, height, width, grain_px)
    return extent[AREA], points, cut


@njit(cache=True, nogil=True)
def choose_in_mask(
    mask: NDArray[np.uint8],
    field: Field,
    differences: NDArray[np.int32],
    runs: Runs,
    box: Box,
    pixels_min: int,
    grain_px: float,
) -> tuple[int, int, int]:
    """As `choose`, of labels that another optimiser wrote."""
    pad(mask, field.rows, field.hot)
    return choose(field, differences, runs, box, pixels_min, grain_px)


@njit(cache=True, nogil=True)
def see(
    picture: Picture,
    layout: Layout,
    entries: NDArray[np.int32],
    cells: NDArray[np.uint32],
    field: Field,
    beta: int,
    differences: NDArray[np.int32],
    mask: NDArray[np.uint8],
    runs: Runs,
    box: Box,
    pixels_min: int,
) -> tuple[int, tuple[int, int, int]]:
    """Everything, with the exact optimum; its energy, and what `choose` returns."""
    measure_pixels(picture, layout, entries, cells, field, differences)
    energy = solve(field, differences, beta, mask)
    grain_px = float(layout.block)
    return energy, choose(field, differences, runs, box, pixels_min, grain_px)
