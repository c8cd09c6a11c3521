"""Which regions of a segmentation are the object, and how likely it is in the picture at all."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from naod.config import SegmentationConfig
from naod.finding.expectation import agreement
from naod.finding.groups import groups_of
from naod.finding.measure import NO_SHAPE, measure_groups
from naod.finding.presence import colour_and_shape, plausibility, probability
from naod.geometry.camera import PinholeCamera
from naod.perception.blob import Blob, blob_of, evidence, find_blob
from naod.perception.components import AREA, SUM_X, SUM_Y, components
from naod.perception.energy import STEPS
from naod.perception.segmenter import Segmentation
from naod.pose.contour import figures
from naod.pose.objects import ObjectShape
from naod.pose.prior import Prior

SURE_STEPS = 3 * STEPS
"""What a pixel says where nothing but its label is known."""


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
) -> Candidate | None:
    """The object in a picture; None when it is more likely not there (`presence_min`)."""
    best = likeliest(segmentation, shape, camera, prior, settings.pixels_min)
    return best if best is not None and best.probability >= settings.presence_min else None


def likeliest(
    segmentation: Segmentation,
    shape: ObjectShape | None,
    camera: PinholeCamera | None,
    prior: Prior | None,
    pixels_min: int,
) -> Candidate | None:
    """What is likeliest the object, however unlikely; None where nothing has its colour.

    shape and camera: without both, colour alone decides. prior: where the object is expected, which
    counts for or against. Cost does not grow with clutter: only some regions are looked at.
    """
    scored = scored_groups(segmentation, shape, camera, prior, pixels_min)
    if scored is None:
        return None
    odds = colour_and_shape(scored.measures, scored.cuts, scored.known) + scored.offsets
    best = int(np.argmax(odds))
    wanted = scored.wanted(best)
    parts = int(np.count_nonzero(wanted))
    blob = _foremost(segmentation, scored, wanted, pixels_min) if parts == 1 else None
    if blob is None:
        blob = blob_of(scored.labels, scored.table, wanted, segmentation.scale)
    return Candidate(blob, probability(float(odds[best])), parts)


def _foremost(
    segmentation: Segmentation, scored: Scored, wanted: NDArray[np.bool_], pixels_min: int
) -> Blob | None:
    """The region with most of the colour, which is measured already, if it is the one wanted."""
    blob = find_blob(segmentation, pixels_min)
    row, grain = scored.table[wanted[1:]][0], segmentation.scale
    if blob is None or blob.area_px != row[AREA] * grain**2:
        return None
    x, y = ((float(row[k]) / float(row[AREA]) + 0.5) * grain - 0.5 for k in (SUM_X, SUM_Y))
    same = abs(blob.centre_px[0] - x) + abs(blob.centre_px[1] - y) < 1e-6
    return blob if same else None


@dataclass(frozen=True, slots=True)
class Scored:
    """Groups of regions that may be the object, and what speaks for each.

    `labels` and `table` as `components` gives, `chosen` and `groups` as `groups_of`, `measures`
    and `cuts` as `measure_groups`. `offsets`: log-odds (m,) that were not fitted to pictures.
    """

    labels: NDArray[np.int32]
    table: NDArray[np.int64]
    chosen: NDArray[np.int64]
    groups: NDArray[np.int64]
    measures: NDArray[np.float64]
    cuts: NDArray[np.int64]
    offsets: NDArray[np.float64]
    known: bool

    def wanted(self, group: int) -> NDArray[np.bool_]:
        """Whether each label is of a group."""
        out = np.zeros(len(self.table) + 1, dtype=np.bool_)
        for n, row in enumerate(self.chosen):
            out[1 + row] = bool(self.groups[group] >> n & 1)
        return out


def scored_groups(
    segmentation: Segmentation,
    shape: ObjectShape | None,
    camera: PinholeCamera | None,
    prior: Prior | None,
    pixels_min: int,
) -> Scored | None:
    """Everything that may be the object; None where nothing has its colour."""
    labels, table = components(segmentation.mask)
    if not len(table):
        return None
    differences = _differences(segmentation)
    told = evidence(labels, differences, len(table))
    known = shape is not None and camera is not None
    chosen, groups = groups_of(table, told, pixels_min, known)
    if not len(groups):
        return None
    sizes = _figures(shape if known else None)
    measures, cuts = measure_groups(labels, table, differences, chosen, groups, sizes)
    offsets = np.zeros(len(groups))
    if shape is not None and camera is not None:
        grain = segmentation.scale
        offsets += plausibility(measures, math.sqrt(camera.fx * camera.fy) / grain)
        if prior is not None:
            offsets += agreement(measures, cuts, grain, shape, camera, prior)
    return Scored(labels, table, chosen, groups, measures, cuts, offsets, known)


def _differences(segmentation: Segmentation) -> NDArray[np.int32]:
    if segmentation.differences is not None:
        return segmentation.differences
    return np.where(segmentation.mask > 0, np.int32(-SURE_STEPS), np.int32(SURE_STEPS))


def _figures(shape: ObjectShape | None) -> tuple[int, float, float]:
    if shape is None:
        return NO_SHAPE, 0.0, 0.0
    kind, half_width, half_height = figures(shape)
    return 1 + kind, half_width, half_height
