"""Learning a colour table from few marked frames (see `naod.perception.colour_table`).

The marked region is grown to the whole object, and what blur, light and other rooms make of both is
sampled. A cell holds the logarithm of how much commoner its colour is in the background than in the
object, both densities smoothed, mixed with a broader one and with a uniform one.
"""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import msgspec
import numpy as np
from numpy.typing import NDArray

from naod.perception.blurring import light_from_yuv, yuv_from_light
from naod.perception.colour_model import ColourModel, ColourTable, Region, learn
from naod.perception.colour_samples import SampleSettings, Seen, sampled
from naod.perception.colour_table import CELLS, Cells, cells_of, packed, smoothed
from naod.perception.energy import STEPS
from naod.perception.growing import grown, region_mask
from naod.perception.reduction import Reduction

Mask = NDArray[np.bool_]
Counts = NDArray[np.float64]

WIDTH = 160
"""Columns that a frame is learnt from, more where the region is small."""
FRAMES_MAX = 2
"""Frames that are used of those given, first and last: more of the same teach little."""
REGION_PIXELS = 100
"""Reduced pixels that a small region is at least looked at with."""
GRAIN_STEPS = 16
"""Steps to which a cell is rounded; the file is smaller for it."""


class TableSettings(msgspec.Struct, frozen=True):
    """How a table is learnt.

    `object_anywhere`: share of the object's colours that are mixed with those of rooms made up,
    `shades`: share of those in other light than the surroundings;
    `around`, `anywhere`: shares of the background's that are from the surroundings and from rooms
    made up, the rest being from elsewhere in the picture. `fine_bins`, `coarse_bins`: standard
    deviations of smoothing, `coarse`: share of the latter. `object_unknown`,
    `background_unknown`: shares of colours never met. `rarity`: nat that always speak against the
    object. `cap`: greatest log-likelihood ratio. `usual`: nat by which an object of one colour is
    likelier where it was learnt, the mean of the pixels that speak for it. One of many colours, or
    among things of its colours, is scaled up to that, by `gain_max` at the most: what sees it later
    goes by what is usual.
    """

    samples: SampleSettings = SampleSettings()
    object_anywhere: float = 0.05
    shades: float = 0.3
    around: float = 0.4
    anywhere: float = 0.4
    fine_bins: float = 0.7
    coarse_bins: float = 2.5
    coarse: float = 0.1
    object_unknown: float = 0.01
    background_unknown: float = 0.3
    rarity: float = 1.1
    cap: float = 6.0
    usual: float = 4.5
    gain_max: float = 3.0
    seed: int = 0


def learn_table(
    frames: Sequence[NDArray[np.uint8]], region: Region, settings: TableSettings | None = None
) -> ColourTable:
    """The colours of the object of which `region` is a part in every frame, YUYV (H, W, 2) uint8.

    Raises InputError as `naod.perception.colour_model.learn` does. Equal frames give an equal
    table.
    """
    settings = settings or TableSettings()
    model = learn(frames, region)
    rng = np.random.default_rng(settings.seed)
    chosen = np.unique(np.linspace(0, len(frames) - 1, FRAMES_MAX).astype(np.int64))
    object_, behind = np.zeros(CELLS), np.zeros(CELLS)
    shown = np.zeros(CELLS)
    for n in chosen:
        light, inside, unsure = marked(frames[n], region)
        cells = cells_of(yuv_from_light(light[inside]))
        shown += np.bincount(cells, minlength=CELLS) / (len(chosen) * len(cells))
        seen = sampled(light, inside, unsure, settings.samples, rng)
        object_ += _object_shares(seen, settings) / len(chosen)
        behind += _background_shares(seen, settings) / len(chosen)
    return table_model(model, _ratios(object_, behind, shown, settings))


def table_model(model: ColourModel, table: Cells) -> ColourTable:
    """A table (CELLS,) int16 beside the Gaussian of the same object."""
    return ColourTable(mean=model.mean, covariance=model.covariance, table=packed(table))


def marked(frame: NDArray[np.uint8], region: Region) -> tuple[NDArray[np.float32], Mask, Mask]:
    """A frame made small, linear light (h, w, 3), what is object in it, and the unsure rim."""
    size = (frame.shape[1], frame.shape[0])
    fine = int(np.sqrt(region.width * region.height / REGION_PIXELS))
    block = max(1, min(-(-size[0] // WIDTH), fine))
    reduction = Reduction(size, -(-size[0] // block))
    picture = reduction(frame)
    inside = grown(
        picture, region_mask(region, reduction.block, (reduction.height, reduction.width))
    )
    rim = cv2.dilate(inside.astype(np.uint8), np.ones((3, 3), dtype=np.uint8)) > 0
    return light_from_yuv(picture), inside, rim & ~inside


def _object_shares(seen: Seen, settings: TableSettings) -> Counts:
    rest = 1.0 - settings.object_anywhere - settings.shades
    mixed = settings.object_anywhere * seen.object_anywhere
    return rest * seen.object + mixed + settings.shades * seen.shades


def _background_shares(seen: Seen, settings: TableSettings) -> Counts:
    rest = 1.0 - settings.around - settings.anywhere
    shares = settings.around * seen.around + settings.anywhere * seen.anywhere
    shares += rest * seen.elsewhere
    return shares / max(float(shares.sum()), 1e-9)


def _ratios(object_: Counts, behind: Counts, shown: Counts, settings: TableSettings) -> Cells:
    """Steps of each cell; `shown`: shares of the object's colours where it was learnt."""
    mine = _density(object_, settings.object_unknown, settings)
    other = _density(behind, settings.background_unknown, settings)
    nats = np.log(other / mine) + settings.rarity
    speaks = shown * (nats < 0.0)
    told = -float(speaks @ nats) / max(float(speaks.sum()), 1e-9)
    gain = min(max(settings.usual / max(told, 1e-9), 1.0), settings.gain_max)
    nats = np.clip(gain * nats, -settings.cap, settings.cap)
    grains = np.rint(nats * (STEPS / GRAIN_STEPS)).astype(np.int16)
    return grains * np.int16(GRAIN_STEPS)


def _density(shares: Counts, unknown: float, settings: TableSettings) -> Counts:
    known = (1.0 - settings.coarse) * smoothed(shares, settings.fine_bins)
    known += settings.coarse * smoothed(shares, settings.coarse_bins)
    return (1.0 - unknown) * known + unknown / CELLS
