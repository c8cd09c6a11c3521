"""From a YUYV picture to the object's box in one compiled call."""

from __future__ import annotations

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
    measure_box,
)
from naod.perception.memory import LINE, Memory, zeroed
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
    WORDS_4,
    Picture,
    bytes_of_picture,
    cells_of_fours,
    cells_of_row,
    picture_in,
)
from naod.perception.runs import AREA, EVIDENCE, Runs, find_runs, weigh
from naod.perception.sight import fill, result_in


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
    height = places.shape[0]
    if kind == WORDS_4:
        # a loop of its own: choosing between kinds in every row takes a fifth longer
        for i in range(height):
            cells_of_fours(picture, i, places[i])
            _vote(votes, places[i], field.votes, field.eights)
            take_row(field.votes, field.eights, field.plane_bytes, i, height, places.shape[1])
        return
    for i in range(height):
        cells_of_row(picture, kind, block, i, places[i])
        _vote(votes, places[i], field.votes, field.eights)
        take_row(field.votes, field.eights, field.plane_bytes, i, height, places.shape[1])


@njit(cache=True, nogil=True)
def _vote(
    votes: NDArray[np.uint8],
    here: NDArray[np.uint32],
    own: NDArray[np.uint8],
    eights: NDArray[np.uint64],
) -> None:
    """Votes of a row's pixels; `own` and `eights` are the same memory."""
    whole = here.size // CELLS_A_WORD
    for k in range(whole):
        eights[k] = _eight(votes, here[CELLS_A_WORD * k : CELLS_A_WORD * (k + 1)])
    for j in range(CELLS_A_WORD * whole, here.size):
        own[j] = votes[here[j]]


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
    result: Memory,
    kind: int,
    block: int,
    values: NDArray[np.int32],
    memory: Memory,
    height: int,
    width: int,
) -> None:
    """Differences of a picture's blocks."""
    _, differences, places, found, _ = result_in(result, height, width)
    _, _, at = _scratch_in(memory, found, height, width)
    picture = picture_in(memory, at, raw, kind)[0]
    for i in range(height):
        cells_of_row(picture, kind, block, i, places[i])
    fill(values, places, differences)


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
    mask, _, places, found, runs = result_in(result, height, width)
    field, box, _ = _scratch_in(memory, found, height, width)
    words = words_of(width)
    bits = field.least[words : (height + 1) * words]
    pack(mask, bits)
    return _choose(bits, values, places, runs, box, pixels_min, grain_px)[1:]


@njit(cache=True, nogil=True)
def see(
    raw: NDArray[np.uint8],
    result: Memory,
    kind: int,
    block: int,
    votes: NDArray[np.uint8],
    values: NDArray[np.int32],
    memory: Memory,
    height: int,
    width: int,
    beta: int,
    pixels_min: int,
) -> tuple[int, int, int, int, int, int, int]:
    """All of it: places, the exact optimum, the object's box.

    `raw`: the picture (H, W, 2). `result`: a Sight's memory. `kind`, `block`: how it is reduced to
    (height, width). `votes`, `values`: of a Lookup. `memory`: of `scratch`. Returns the energy,
    waves of the cut, pixels, boundary points and cut sides of the object, runs and regions of the
    mask; no pixels: no region has `pixels_min`.
    """
    mask, _, places, found, runs = result_in(result, height, width)
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
