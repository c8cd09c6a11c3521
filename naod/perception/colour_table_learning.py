"""Learning a colour table from few marked frames (see `naod.perception.colour_table`).

The marked region is grown to the whole object, cut out, and blurred over its surroundings and over
rooms made up, in several lights. What a cell then saw of object and background, and the paper's
energy as a weak prior, give its log-likelihood ratio.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import msgspec
import numpy as np
from numpy.typing import NDArray

from naod.config import SegmentationConfig
from naod.perception.blurring import (
    Layers,
    cut_out,
    light_from_yuv,
    motions,
    smeared,
    yuv_from_light,
)
from naod.perception.colour_model import ColourModel, ColourTable, Region, learn
from naod.perception.colour_table import (
    BINS,
    CELLS,
    STEPS_MAX,
    UNSEEN,
    Cells,
    cell_colours,
    cells_of,
    packed,
)
from naod.perception.encoding import LIGHT
from naod.perception.energy import STEPS, Singletons
from naod.perception.growing import grown, region_mask
from naod.perception.reduction import Reduction

Floats = NDArray[np.float32]
Mask = NDArray[np.bool_]
Counts = NDArray[np.float64]

FRAMES_MAX = 3
"""Frames that are used of those given, first and last included: more of the same teach little."""
REGION_PIXELS = 100
"""Reduced pixels that a small region is at least looked at with."""
FLOOD = 30
"""So many times the region's area, and the Gaussian took more than the object."""


class TableSettings(msgspec.Struct, frozen=True):
    """How a table is learnt.

    `blurs`: lengths of motion, relative to the side of a square of the object's area; `turns`:
    directions of each. `lights`: brightness tried, `light_shares`: how often. `ring`: width of the
    surroundings, relative to the same side. `room`: weight of rooms made up. `prior`: weight of the
    paper's energy, in thousandths of the object's area. `noise_std` in 8-bit levels. `cap`:
    greatest log-likelihood ratio. `samples_max`: pixels per frame and motion.
    """

    blurs: tuple[float, ...] = (0.0, 0.3, 0.7)
    turns: int = 4
    lights: tuple[float, ...] = (0.6, 0.8, 1.0, 1.25, 1.5)
    light_shares: tuple[float, ...] = (0.1, 0.2, 0.4, 0.2, 0.1)
    ring: float = 0.5
    room: float = 0.15
    prior: float = 2.0
    noise_std: float = 3.0
    cap: float = 6.0
    samples_max: int = 4000
    seed: int = 0


@dataclass(frozen=True, slots=True)
class _Marked:
    """A frame made small, in linear light (h, w, 3), and what of it is object and unsure."""

    light: Floats
    inside: Mask
    unsure: Mask


def learn_table(
    frames: Sequence[NDArray[np.uint8]],
    region: Region,
    settings: TableSettings | None = None,
    energy: SegmentationConfig | None = None,
) -> ColourTable:
    """The colours of the object of which `region` is a part in every frame, YUYV (H, W, 2) uint8.

    Raises InputError as `naod.perception.colour_model.learn` does. `energy`: where the paper's
    energy decides for want of anything better. Equal frames give an equal table.
    """
    settings, energy = settings or TableSettings(), energy or SegmentationConfig()
    model = learn(frames, region)
    paper = Singletons(model, energy.background_energy, energy.light_std)
    rng = np.random.default_rng(settings.seed)
    chosen = np.unique(np.linspace(0, len(frames) - 1, FRAMES_MAX).astype(np.int64))
    object_, behind = np.zeros(CELLS), np.zeros(CELLS)
    for n in chosen:
        marked = _marked(frames[n], region, paper, energy.width)
        seen = _counted(marked, settings, rng)
        object_ += seen[0] / len(chosen)
        behind += seen[1] / len(chosen)
    table = _ratios(smoothed(object_), smoothed(behind), paper, settings)
    return table_model(model, table)


def table_model(model: ColourModel, table: Cells) -> ColourTable:
    """A table (CELLS,) int16 beside the Gaussian of the same object."""
    return ColourTable(mean=model.mean, covariance=model.covariance, table=packed(table))


def smoothed(counts: Counts) -> Counts:
    """Counts (CELLS,) shared out with the cells beside, a quarter each way along every axis."""
    cube: Counts = counts.reshape(BINS, BINS, BINS)
    for axis in range(3):
        padded = np.pad(cube, [(1, 1) if n == axis else (0, 0) for n in range(3)], mode="edge")
        parts = [padded.take(range(k, k + BINS), axis) for k in range(3)]
        cube = 0.25 * parts[0] + 0.5 * parts[1] + 0.25 * parts[2]
    return cube.ravel()


def _marked(frame: NDArray[np.uint8], region: Region, paper: Singletons, width: int) -> _Marked:
    """Made small, the region grown to the object; the rest that looks like it is unsure."""
    size = (frame.shape[1], frame.shape[0])
    coarse = -(-size[0] // width)
    fine = int(np.sqrt(region.width * region.height / REGION_PIXELS))
    block = max(1, min(coarse, fine))
    reduction = Reduction(size, -(-size[0] // block))
    picture = reduction(frame)
    known = region_mask(region, reduction.block, (reduction.height, reduction.width))
    differences = np.empty(known.shape, dtype=np.int32)
    paper.differences(picture, differences)
    inside = grown(differences, known)
    alike = differences < 0
    if np.count_nonzero(inside) > FLOOD * np.count_nonzero(known):
        inside, alike = _grown_apart(picture, known, differences), np.zeros_like(known)
    rim = cv2.dilate(inside.astype(np.uint8), np.ones((3, 3), dtype=np.uint8)) > 0
    return _Marked(light_from_yuv(picture), inside, (rim | alike) & ~inside)


def _grown_apart(picture: Floats, known: Mask, differences: NDArray[np.int32]) -> Mask:
    """The object by the colours that the region has more of than the rest of the picture."""
    cells = cells_of(picture)
    shares = []
    for part in (known, ~known):
        counts = np.bincount(cells[part], minlength=CELLS) / np.count_nonzero(part)
        shares.append(smoothed(smoothed(counts))[cells] + 1e-4)
    apart = np.log(shares[1] / shares[0]) * STEPS
    return grown(np.maximum(differences, apart.astype(np.int32)), known)


def _counted(
    marked: _Marked, settings: TableSettings, rng: np.random.Generator
) -> tuple[Counts, Counts]:
    """What each cell saw of object and of background, in thousandths of the object's area."""
    area = int(np.count_nonzero(marked.inside))
    side = float(np.sqrt(area))
    around = 2 * max(3, round(settings.ring * side)) + 3
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (around, around))
    zone = cv2.dilate(marked.inside.astype(np.uint8), disc) > 0
    elsewhere = marked.light[~(marked.inside | marked.unsure)]
    # no motion brings light from farther away
    near = _box_of(zone, round(max(settings.blurs) * side) + 2)
    zone, unsure = zone[near], marked.unsure[near]
    layers = cut_out(marked.light[near], marked.inside[near], unsure)
    object_, behind = np.zeros(CELLS), np.zeros(CELLS)
    lengths = tuple(blur * side for blur in settings.blurs)
    for length, angle in motions(lengths, settings.turns):
        places = np.flatnonzero(zone if length > 0.0 else zone & ~unsure)
        weight = 1000.0 / area * (1.0 / settings.turns if length > 0.0 else 1.0)
        if len(places) > settings.samples_max:
            weight *= len(places) / settings.samples_max
            places = rng.choice(places, settings.samples_max, replace=False)
        sample = _Sample(smeared(layers, length, angle), places, settings, rng)
        sample.count_surroundings(weight, object_, behind)
        sample.count_rooms(weight * settings.room, elsewhere, object_, behind)
    return object_, behind


def _box_of(mask: Mask, margin: int) -> tuple[slice, slice]:
    """Rows and columns that hold a mask and a margin around it, within the picture."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return (
        slice(max(int(rows[0]) - margin, 0), int(rows[-1]) + 1 + margin),
        slice(max(int(columns[0]) - margin, 0), int(columns[-1]) + 1 + margin),
    )


class _Sample:
    """Pixels of blurred layers, each in a light of its own."""

    def __init__(
        self,
        layers: Layers,
        places: NDArray[np.int64],
        settings: TableSettings,
        rng: np.random.Generator,
    ) -> None:
        self._rng, self._noise = rng, settings.noise_std
        self._share = layers.share.ravel()[places]
        self._object = layers.object.reshape(-1, 3)[places]
        self._behind = layers.behind.reshape(-1, 3)[places]
        light = rng.choice(settings.lights, len(places), p=settings.light_shares)
        self._brightness = light.astype(np.float32)[:, None]

    def count_surroundings(self, weight: float, object_: Counts, behind: Counts) -> None:
        """As the blurred frame has them."""
        cells = self._cells(self._object + self._behind)
        most = self._share >= 0.5
        object_ += weight * np.bincount(cells[most], minlength=CELLS)
        behind += weight * np.bincount(cells[~most], minlength=CELLS)

    def count_rooms(
        self, weight: float, elsewhere: Floats, object_: Counts, behind: Counts
    ) -> None:
        """With something made up behind the object; `elsewhere` (n, 3): light to choose from."""
        left = 1.0 - self._share[:, None]
        cells = self._cells(self._object + left * _rooms(len(left), elsewhere, self._rng))
        mixed = (self._share >= 0.5) & (self._share < 1.0)
        object_ += weight * np.bincount(cells[mixed], minlength=CELLS)
        behind += weight * np.bincount(cells[self._share < 0.5], minlength=CELLS)

    def _cells(self, light: Floats) -> NDArray[np.int64]:
        noise = self._rng.normal(0.0, self._noise, light.shape).astype(np.float32)
        return cells_of(yuv_from_light(self._brightness * light) + noise)


def _rooms(count: int, elsewhere: Floats, rng: np.random.Generator) -> Floats:
    """Light (count, 3) of what may be behind: near greys, any colour, and this room's own."""
    greys = rng.uniform(0.0, 255.0, (count, 1)) + rng.normal(0.0, 12.0, (count, 3))
    colours = rng.uniform(0.0, 255.0, (count, 3))
    kind = rng.integers(0, 3, count)
    levels = np.clip(np.where(kind[:, None] == 0, greys, colours), 0.0, 255.0)
    light = np.interp(levels, np.arange(256), LIGHT).astype(np.float32)
    if len(elsewhere):
        own = kind == 2
        light[own] = elsewhere[rng.integers(0, len(elsewhere), np.count_nonzero(own))]
    return light


def _ratios(object_: Counts, behind: Counts, paper: Singletons, settings: TableSettings) -> Cells:
    """Steps of each cell; UNSEEN where the prior outweighs what was seen ten times."""
    printed = np.empty((BINS * BINS, BINS), dtype=np.int32)
    paper.differences(cell_colours(), printed)
    odds = np.clip(printed.ravel() / STEPS, -settings.cap, settings.cap)
    likely = 1.0 / (1.0 + np.exp(odds))
    ratio = np.log((behind + settings.prior * (1.0 - likely)) / (object_ + settings.prior * likely))
    steps = np.rint(np.clip(ratio, -settings.cap, settings.cap) * STEPS)
    steps = np.clip(steps, -STEPS_MAX, STEPS_MAX).astype(np.int16)
    return np.where(10.0 * (object_ + behind) < settings.prior, np.int16(UNSEEN), steps)
