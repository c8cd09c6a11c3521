"""A segmenter makes no arrays in the steady state, and never changes what somebody holds."""

from __future__ import annotations

import resource
import tracemalloc

import numpy as np
import pytest

from naod.config import SegmentationConfig
from naod.perception.blob import find_blob
from naod.perception.colour_model import ColourModel
from naod.perception.segmenter import Segmenter

SIZE = (320, 240)
MODEL = ColourModel(
    mean=(90.0, 110.0, 200.0),
    covariance=((200.0, 0.0, 0.0), (0.0, 60.0, 0.0), (0.0, 0.0, 60.0)),
)


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
