"""How the time grows with the size of the picture that is labelled, and with its colours."""

from __future__ import annotations

from collections.abc import Callable

import msgspec
import numpy as np
from numpy.typing import NDArray

from naod.bench.frames import Walk, WalkSettings
from naod.bench.table import Report
from naod.bench.timing import interleaved
from naod.config import SegmentationConfig, Width
from naod.perception.blob import find_blob
from naod.perception.colour_model import Region
from naod.perception.learning import KINDS, ModelKind, learn_model
from naod.perception.segmenter import Segmenter

WIDTHS: tuple[Width, ...] = (80, 160, 320)
COLOURS = (1, 2, 4, 8)
FRAMES, PER_FRAME = 8, 3
"""Pictures, and how often each is seen."""

Progress = Callable[[str], None]
Work = Callable[[int], object]
Picture = NDArray[np.uint8]


def run(settings: WalkSettings, progress: Progress) -> Report:
    """Frame to box, each kind of model, in turns."""
    progress("growth")
    small = msgspec.structs.replace(settings, count=min(settings.count, FRAMES))
    taken = Walk(small).taken("sharp", 0.0)
    frames = [frame.yuyv for frame in taken.frames]
    work: dict[str, Work] = {}
    for kind in KINDS:
        for width in WIDTHS:
            work[f"{kind}, {width} wide"] = _box([taken.shown], taken.region, kind, width, frames)
        for colours in COLOURS:
            painted = [striped(yuyv, taken.region, colours) for yuyv in [taken.shown, *frames]]
            name = f"{kind}, {colours} colours"
            work[name] = _box(painted[:1], taken.region, kind, WIDTHS[1], painted[1:])
    reference = f"{KINDS[0]}, {WIDTHS[1]} wide"
    timings = interleaved(work, reference, PER_FRAME * len(frames))
    rows = tuple((timing.name, timing.median_ms, timing.ratio) for timing in timings)
    notes = (f"colours: stripes painted on the marked region, {WIDTHS[1]} wide",)
    return Report("growth", ("model, size", "ms", f"times {reference}"), rows, notes)


def _box(
    shown: list[Picture], region: Region, kind: ModelKind, width: Width, frames: list[Picture]
) -> Work:
    height, full = shown[0].shape[:2]
    model = learn_model(shown, region, kind)
    segmenter = Segmenter(model, SegmentationConfig(width=width), (full, height))
    return lambda n: find_blob(segmenter.segment(frames[n % len(frames)]))


def striped(yuyv: Picture, region: Region, colours: int) -> Picture:
    """The picture (H, W, 2) with stripes of so many hues over the region; 1 leaves it alone."""
    if colours == 1:
        return yuyv
    out = yuyv.copy()
    left, width = region.x // 2 * 2, region.width // 2 * 2
    for row in range(region.height):
        angle = 2.0 * np.pi * (row * colours // region.height) / colours
        line = out[region.y + row, left : left + width]
        line[0::2, 1] = np.uint8(128 + 90 * np.cos(angle))
        line[1::2, 1] = np.uint8(128 + 90 * np.sin(angle))
    return out
