"""What is made of one picture, in memory that is used again once nobody holds it."""

from __future__ import annotations

import sys

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.box import Found, bytes_of_found, found_in
from naod.perception.memory import LINE, Memory, int32s, uint8s, uint32s, views_of, zeroed
from naod.perception.runs import Runs, bytes_of_runs, paint, runs_in


@njit(cache=True, nogil=True)
def result_in(
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
def fill(
    values: NDArray[np.int32], places: NDArray[np.uint32], differences: NDArray[np.int32]
) -> None:
    """Differences (h, w) from a lookup's values, at places (h, w) in it."""
    for i in range(places.shape[0]):
        here, out = places[i], differences[i]
        for j in range(here.size):
            out[j] = values[here[j]]


@njit(cache=True, nogil=True)
def _labelled(
    memory: Memory, height: int, width: int, count: int, regions: int
) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    runs = result_in(memory, height, width)[-1]
    labels = np.zeros((height, width), dtype=np.int32)
    paint(runs, count, labels)
    return labels, runs.table[1 : regions + 1].copy()


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
        mask, differences, places, found, runs = result_in(self.memory, height, width)
        views = views_of(self.memory, (mask, differences, places))
        self.mask, self._differences, self._places = views
        self.found = Found(*views_of(self.memory, found))
        self._corners, self._centre = self.found.corners, self.found.centre
        self.runs = Runs(*views_of(self.memory, runs))
        self._whole = self.memory.base
        self.values: NDArray[np.int32] | None = None
        self.pixels_min = pixels_min
        self.pixels = self.points = self.cut = self.run_count = self.regions = 0

    @property
    def differences(self) -> NDArray[np.int32]:
        """(h, w) int32 of all pixels, looked up when somebody asks: few do."""
        if self.values is not None:
            fill(self.values, self._places, self._differences)
            self.values = None
        return self._differences

    def labelled(self) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
        """Labels (h, w) of the mask's regions, and their table (n, 8), in memory of their own."""
        found: tuple[NDArray[np.int32], NDArray[np.int64]] = _labelled(
            self.memory, *self.mask.shape, self.run_count, self.regions
        )
        return found

    def holders(self) -> int:
        """References to this, to the memory by views of it, and to what is handed out as it is."""
        count = sys.getrefcount
        handed_out = count(self.mask) + count(self._differences)
        handed_out += count(self._corners) + count(self._centre)
        return count(self) + count(self._whole) + handed_out


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
