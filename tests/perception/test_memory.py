"""A segmenter makes no arrays in the steady state, and never changes what somebody holds."""

from __future__ import annotations

import resource
import tracemalloc
from collections.abc import Callable, Iterable

import numpy as np
import pytest
from numba import njit

from naod.config import SegmentationConfig
from naod.perception.blob import find_blob
from naod.perception.box import box_in, bytes_of_box, bytes_of_found, found_in
from naod.perception.colour_model import ColourModel
from naod.perception.memory import fetch, views_of, zeroed
from naod.perception.optimum_field import bytes_of_field, field_in
from naod.perception.quantising import WORDS_4, picture_in
from naod.perception.runs import bytes_of_runs, runs_in
from naod.perception.seeing import scratch
from naod.perception.segmenter import Segmenter
from naod.perception.sight import Sight, result_in

SIZE = (320, 240)
MODEL = ColourModel(
    mean=(90.0, 110.0, 200.0),
    covariance=((200.0, 0.0, 0.0), (0.0, 60.0, 0.0), (0.0, 0.0, 60.0)),
)


Cut = Callable[[np.ndarray, int, int], tuple[Iterable[np.ndarray], int]]


def _box_in(memory: np.ndarray, height: int, width: int) -> tuple[Iterable[np.ndarray], int]:
    found = found_in(zeroed(bytes_of_found(height, width)), 0, height, width)[0]
    box, end = box_in(memory, 0, found, height, width)
    return box[len(found) :], end


CUTS: dict[str, tuple[Callable[[int, int], int], Cut]] = {
    "field": (bytes_of_field, lambda memory, *size: field_in(memory, 0, *size)),
    "found": (bytes_of_found, lambda memory, *size: found_in(memory, 0, *size)),
    "box": (bytes_of_box, _box_in),
    "runs": (bytes_of_runs, lambda memory, *size: runs_in(memory, 0, *size)),
}


@pytest.mark.parametrize("size", [(1, 1), (2, 3), (5, 64), (7, 63), (64, 5), (120, 160), (37, 129)])
@pytest.mark.parametrize("what", CUTS)
def test_what_is_cut_lies_within_the_memory(what: str, size: tuple[int, int]) -> None:
    bytes_of, cut = CUTS[what]
    memory = zeroed(bytes_of(*size))
    arrays, end = cut(memory, *size)
    assert end <= memory.size
    for array in arrays:
        first = array.ctypes.data - memory.ctypes.data
        assert 0 <= first <= first + array.nbytes <= end


@pytest.mark.parametrize("size", [(1, 1), (5, 17), (120, 160), (37, 129)])
def test_all_that_a_picture_takes_lies_within_its_memory(size: tuple[int, int]) -> None:
    height, width = size
    sight, memory = Sight(height, width, 12), scratch(height, width, 4 * width)
    *parts, found, runs = result_in(sight.memory, height, width)
    raw = np.zeros((4 * height, 4 * width, 2), dtype=np.uint8)
    raw.setflags(write=False)
    end = box_in(memory, field_in(memory, 0, *size)[1], found, *size)[1]
    end = picture_in(memory, end, raw, WORDS_4)[1]
    assert end <= memory.size
    for array in (*parts, *found, *runs):
        first = array.ctypes.data - sight.memory.ctypes.data
        assert 0 <= first <= first + array.nbytes <= sight.memory.size


def test_views_for_python_hold_the_memory() -> None:
    memory = zeroed(bytes_of_runs(4, 6))
    runs = tuple(views_of(memory, runs_in(memory, 0, 4, 6)[0]))
    assert all(view.base is memory.base for view in runs)
    runs[0][:] = 7
    assert (memory.view(np.int32)[: runs[0].size] == 7).all()


@pytest.mark.parametrize("count", [1, 8, 1000])
def test_fetching_changes_nothing_even_beyond_the_end(count: int) -> None:
    words = np.arange(count, dtype=np.uint64)

    @njit
    def fetch_all(words: np.ndarray) -> None:
        for k in range(words.size + 4096):
            fetch(words, k)

    fetch_all(words)
    assert (words == np.arange(count)).all()


def pictures(count: int, size: tuple[int, int] = SIZE) -> list[np.ndarray]:
    """A square of the model's colour that moves through noise."""
    width, height = size
    taken = []
    for n in range(count):
        yuyv = np.random.default_rng(n).integers(40, 120, (height, width, 2)).astype(np.uint8)
        x, y = 8 + 6 * n % (width // 2), 8 + 2 * n % (height // 2)
        inside = yuyv[y : y + height // 4, 2 * (x // 2) : 2 * (x // 2) + width // 4]
        inside[..., 0], inside[:, ::2, 1], inside[:, 1::2, 1] = 90, 110, 200
        taken.append(yuyv)
    return taken


def blocks_of_numpy() -> int:
    taken = tracemalloc.take_snapshot()
    domain = tracemalloc.DomainFilter(True, np.lib.tracemalloc_domain)
    return sum(trace.size for trace in taken.filter_traces([domain]).traces)


@pytest.mark.parametrize("optimiser", ["exact", "icm"])
def test_no_array_is_made_for_a_picture(optimiser: str) -> None:
    segmenter = Segmenter(MODEL, SegmentationConfig(optimiser=optimiser), SIZE)  # type: ignore[arg-type]
    frames = pictures(10)
    last = None
    for frame in frames:
        found = segmenter.segment(frame)
        last = found, find_blob(found)
    tracemalloc.start()
    try:
        for n in range(300):
            # the last result is held while the next is made, as a loop does
            found = segmenter.segment(frames[n % len(frames)])
            last = found, find_blob(found)
            assert last[1] is not None
        assert blocks_of_numpy() == 0
        assert tracemalloc.get_traced_memory()[1] < 8192
    finally:
        tracemalloc.stop()


def test_whoever_keeps_results_keeps_them_unchanged() -> None:
    segmenter = Segmenter(MODEL, SegmentationConfig(), SIZE)
    frames = pictures(8)
    kept = []
    for frame in frames:
        segmentation = segmenter.segment(frame)
        blob = find_blob(segmentation)
        assert blob is not None
        # of some the mask alone is kept, of some the corners alone
        kept.append((segmentation.mask if len(kept) % 2 else None, blob.corners_px))
        del segmentation, blob
    for frame, (mask, corners) in zip(frames, kept, strict=True):
        again = Segmenter(MODEL, SegmentationConfig(), SIZE).segment(frame)
        found = find_blob(again)
        assert found is not None
        assert (corners == found.corners_px).all()
        assert mask is None or (mask == again.mask).all()


def resident_kb() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def run(segmenter: Segmenter, frames: list[np.ndarray], count: int) -> None:
    for n in range(count):
        assert find_blob(segmenter.segment(frames[n % len(frames)])) is not None


@pytest.mark.parametrize(
    "count", [4_000, pytest.param(100_000, marks=pytest.mark.slow)], ids=["some", "many"]
)
def test_memory_is_flat(count: int) -> None:
    size = (80, 60)
    segmenter = Segmenter(MODEL, SegmentationConfig(), size)
    frames = pictures(20, size)
    run(segmenter, frames, 500)
    before = resident_kb()
    run(segmenter, frames, count)
    assert resident_kb() - before < 512
