"""Which regions of a segmentation are the object, and how likely it is in the picture at all."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from naod.config import SegmentationConfig
from naod.finding.expectation import agreement
from naod.finding.hue import CLIP, NO_OWN, NO_PICTURE, Colours
from naod.finding.measure import COLOUR, NO_SHAPE, PIXELS
from naod.finding.parts import parts_of
from naod.finding.presence import probability, weights_of
from naod.finding.regions import Regions, cores_of, regions_of
from naod.finding.scoring import score_groups
from naod.geometry.camera import PinholeCamera
from naod.perception.blob import Blob, blob_of, find_blob
from naod.perception.components import AREA, SUM_X, SUM_Y
from naod.perception.segmenter import Segmentation
from naod.pose.contour import figures
from naod.pose.objects import ObjectShape
from naod.pose.prior import Prior

SURE_ODDS, SURE_COLOUR = 1.5, 5.5
"""Log-odds, and mean nat of colour, from which both nobody looks further: a region that is likely
the object but not all of its colour may be the object and what stands behind it."""

LIKELY_ODDS = 0.5
"""Log-odds from which a region's size tells more than how purely it is of the object's colour."""

FINER_ODDS = 0.1
"""By which a part of a region must be likelier than any whole one to be taken for the object."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """What in the picture is most likely the object.

    `blob`: all its regions as one. `probability`: that it is the object. `parts`: regions.
    """

    blob: Blob
    probability: float
    parts: int


def find_object(
    segmentation: Segmentation,
    shape: ObjectShape | None,
    camera: PinholeCamera | None,
    prior: Prior | None,
    settings: SegmentationConfig,
    blur_px: float = 0.0,
    colours: Colours | None = None,
) -> Candidate | None:
    """The object in a picture; None when it is more likely not there (`presence_min`)."""
    best = likeliest(segmentation, shape, camera, prior, settings.pixels_min, blur_px, colours)
    return best if best is not None and best.probability >= settings.presence_min else None


def likeliest(
    segmentation: Segmentation,
    shape: ObjectShape | None,
    camera: PinholeCamera | None,
    prior: Prior | None,
    pixels_min: int,
    blur_px: float = 0.0,
    colours: Colours | None = None,
) -> Candidate | None:
    """What is likeliest the object, however unlikely; None where nothing has its colour.

    shape and camera: without both, colour alone decides. prior: where the object is expected, which
    counts for or against. blur_px: how far it moves through the full picture during the exposure, 0
    where nobody knows. colours: the picture itself, in which hue and tone are seen; without it,
    what is likeliest is less sure. Cost does not grow with clutter: only some regions are looked
    at, and their parts only where no region is surely it and it alone.
    """
    regions = regions_of(segmentation)
    expected = Expected(shape, camera, prior, blur_px, colours)
    scored = scored_groups(segmentation, regions, expected, pixels_min)
    if scored is None:
        return None
    best, odds = scored.best()
    if scored.known and not scored.surely(best, odds):
        for apart in finer(regions, colours):
            other = scored_groups(segmentation, apart, expected, pixels_min)
            if other is None:
                continue
            likely, likely_odds = other.best()
            if likely_odds > odds + FINER_ODDS:
                scored, best, odds = other, likely, likely_odds
            if other.surely(likely, likely_odds):
                break
    rows, blob = scored.rows(best), None
    if len(rows) == 1 and scored.regions is regions:
        blob = _foremost(segmentation, regions.table[rows[0]], pixels_min)
    if blob is None:
        wanted = scored.wanted(best)
        blob = blob_of(scored.regions.labels, scored.regions.table, wanted, segmentation.scale)
    return Candidate(blob, probability(odds), len(rows))


def finer(regions: Regions, colours: Colours | None) -> Iterator[Regions]:
    """Parts of regions as they are tried in turn: cores, and what the picture's edges part."""
    yield cores_of(regions)
    if colours is not None:
        yield parts_of(regions, colours.picture)


def _foremost(segmentation: Segmentation, row: NDArray[np.int64], pixels_min: int) -> Blob | None:
    """The region with most of the colour, which is measured already, if it is that of a row."""
    blob = find_blob(segmentation, pixels_min)
    area, sum_x, sum_y = int(row[AREA]), int(row[SUM_X]), int(row[SUM_Y])
    grain = segmentation.scale
    if blob is None or blob.area_px != area * grain**2:
        return None
    x, y = blob.centre_px.tolist()
    gap = abs(x - (sum_x / area + 0.5) * grain + 0.5) + abs(y - (sum_y / area + 0.5) * grain + 0.5)
    return blob if gap < 1e-6 else None


@dataclass(frozen=True, slots=True)
class Expected:
    """What is looked for, from where, where it may be, and how much it is smeared."""

    shape: ObjectShape | None = None
    camera: PinholeCamera | None = None
    prior: Prior | None = None
    blur_px: float = 0.0
    colours: Colours | None = None


@dataclass(frozen=True, slots=True)
class Scored:
    """Groups of regions that may be the object, and what speaks for each.

    `chosen` and `groups` as `groups_of`, `measures` and `cuts` as `measure_groups`. `fitted`:
    log-odds (m,) by the measures, `offsets`: to those, which were not fitted to pictures.
    """

    regions: Regions
    chosen: NDArray[np.int64]
    groups: NDArray[np.int64]
    measures: NDArray[np.float64]
    cuts: NDArray[np.int64]
    fitted: NDArray[np.float64]
    offsets: NDArray[np.float64]
    known: bool

    def wanted(self, group: int) -> NDArray[np.bool_]:
        """Whether each label is of a group."""
        out = np.zeros(len(self.regions.table) + 1, dtype=np.bool_)
        for row in self.rows(group):
            out[1 + row] = True
        return out

    def rows(self, group: int) -> list[int]:
        """Rows of the regions' table that make up a group."""
        members = int(self.groups[group])
        return [row for n, row in enumerate(self.chosen.tolist()) if members >> n & 1]

    def surely(self, group: int, odds: float) -> bool:
        """Whether a group with such log-odds is the object and nothing else."""
        return odds >= SURE_ODDS and bool(self.measures[group, COLOUR] >= SURE_COLOUR)

    def best(self) -> tuple[int, float]:
        """The likeliest group and its log-odds.

        Without a shape, of those that are likely the one with most pixels: a large object has
        shades in it that a small thing beside it has not.
        """
        odds = self.fitted + self.offsets
        told = odds
        if not self.known:
            likely = odds >= min(float(odds.max()), LIKELY_ODDS)
            told = np.where(likely, self.measures[:, PIXELS], 0.0)
        best = int(np.argmax(told))
        return best, float(odds[best])


def scored_groups(
    segmentation: Segmentation, regions: Regions, expected: Expected, pixels_min: int
) -> Scored | None:
    """Everything that may be the object; None where nothing has its colour."""
    shape, camera, grain = expected.shape, expected.camera, segmentation.scale
    known = shape is not None and camera is not None
    if not len(regions.table):
        return None
    colours, focal_px = expected.colours, 0.0
    if shape is not None and camera is not None:
        focal_px = math.sqrt(camera.fx * camera.fy) / grain
    chosen, groups, measures, cuts, odds, offsets = score_groups(
        regions.labels,
        regions.table,
        regions.told,
        regions.differences,
        regions.colours,
        pixels_min,
        _figures(shape if known else None),
        expected.blur_px / grain,
        colours.picture if colours else NO_PICTURE,
        colours.own if colours else NO_OWN,
        colours.peak if colours else CLIP,
        regions.around_max,
        focal_px,
        weights_of(known),
    )
    if not len(groups):
        return None
    if shape is not None and camera is not None and expected.prior is not None:
        offsets += agreement(measures, cuts, grain, shape, camera, expected.prior)
    return Scored(regions, chosen, groups, measures, cuts, odds, offsets, known)


def _figures(shape: ObjectShape | None) -> tuple[int, float, float]:
    if shape is None:
        return NO_SHAPE, 0.0, 0.0
    kind, half_width, half_height = figures(shape)
    return 1 + kind, half_width, half_height
