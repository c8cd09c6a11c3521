"""The object's colour in light that changes slowly.

What changes is one factor on all colours, Y : U - 128 : V - 128 staying in proportion, followed by
a scalar Kalman filter from pixels deep inside the object. It is tied to the learnt colour: the
first sightings say what is normal, no other hue is followed, no jump, and never beyond LOG_MAX.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from naod.perception.blob import Blob
from naod.perception.colour_model import (
    ColourMixture,
    ColourModel,
    ColourTable,
    Component,
    Triple,
)
from naod.perception.colour_table import cell_colours, cells_of, packed, unpacked
from naod.perception.segmenter import Segmentation

NORMAL_LOOKS = 5
"""Sightings that say how the object looks in the light that it was learnt in."""
RATE_STD = 0.02
"""Change of the logarithm in a second that is taken for light, as a random walk."""
LOOK_STD = 0.04
"""Of one look's logarithm: shading, another side, what the blur mixes in."""
GATE = 3.0
"""Standard deviations beyond which a look is of something else; that widens only with time, in
doubt too: what comes before the object for some seconds is not taken for it in another light."""
STD_MAX = 0.15
"""However long nothing was seen, no greater change is believed at once."""
LOG_MAX = 0.5
"""Of the whole change, either way; in linear light a factor of three."""
HUE_MAX = 0.15
"""Greatest change of U - 128 and V - 128 relative to Y."""
DEEP_PIXELS = 8
TRUST_S = 2.0
"""Time constant of trust; a look agrees or not."""
DOUBT_BELOW, SURE_ABOVE = 0.3, 0.7
SURE_ENOUGH = 0.5
"""Probability that it is the object, below which nothing is learnt from it."""
QUANTUM = 0.04
"""Change of the logarithm that is worth another table."""

_NO_COLOUR = np.array([0.0, 128.0, 128.0])


@dataclass(frozen=True, slots=True)
class Drift:
    """How the light stands to that of learning. `learnt` is the model it belongs to.

    `log`: of the factor on encoded colours, with `variance`; `normal`: the object's mean colour
    (Y, U - 128, V - 128) in the first light, over `looks` sightings. `trust` 0 to 1; `doubtful`
    from when it fell until it is back. `lit`: the model for the light at `lit_log`.
    """

    learnt: ColourModel
    lit: ColourModel
    lit_log: float = 0.0
    log: float = 0.0
    variance: float = LOOK_STD**2
    normal: Triple = (0.0, 0.0, 0.0)
    looks: int = 0
    trust: float = 1.0
    doubtful: bool = False
    stamp_ns: int | None = None

    @staticmethod
    def of(model: ColourModel) -> Drift:
        """Nothing has changed yet."""
        return Drift(model, model)


def seen_colour(
    yuyv: NDArray[np.uint8], segmentation: Segmentation, blob: Blob
) -> NDArray[np.float64] | None:
    """Mean Y, U - 128, V - 128 (3,) deep inside a blob; None where it is too small."""
    inside = np.zeros_like(segmentation.mask)
    corners = (blob.corners_px + 0.5) / segmentation.scale - 0.5
    low, high = np.maximum(corners.min(axis=0), 0), corners.max(axis=0)
    rows, columns = slice(int(low[1]), int(high[1]) + 2), slice(int(low[0]), int(high[0]) + 2)
    inside[rows, columns] = segmentation.mask[rows, columns]
    deep = cv2.erode(inside, np.ones((3, 3), dtype=np.uint8), borderValue=0)
    i, j = np.nonzero(deep)
    if len(i) < DEEP_PIXELS:
        return None
    step, half = int(segmentation.scale), int(segmentation.scale) // 2
    y, x = np.minimum(i * step + half, yuyv.shape[0] - 1), j * step + half
    x = np.minimum(x - x % 2, yuyv.shape[1] - 2)
    pixels = np.stack([yuyv[y, x, 0], yuyv[y, x, 1], yuyv[y, x + 1, 1]], axis=1)
    return np.asarray(pixels.mean(axis=0, dtype=np.float64) - _NO_COLOUR)


def followed(drift: Drift, colour: NDArray[np.float64] | None, stamp_ns: int) -> Drift:
    """After a picture taken at `stamp_ns` in which the object had a mean `colour` as above."""
    if colour is None or colour[0] < 1.0:
        return drift
    passed = 0.0 if drift.stamp_ns is None else max((stamp_ns - drift.stamp_ns) / 1e9, 0.0)
    drift = replace(drift, stamp_ns=stamp_ns)
    if drift.looks < NORMAL_LOOKS:
        mean = (np.array(drift.normal) * drift.looks + colour) / (drift.looks + 1)
        return replace(drift, normal=tuple(mean.tolist()), looks=drift.looks + 1)
    variance = min(drift.variance + RATE_STD**2 * passed, STD_MAX**2)
    change = math.log(colour[0] / drift.normal[0]) - drift.log
    hue = colour[1:] / colour[0] - np.array(drift.normal[1:]) / drift.normal[0]
    agrees = change**2 <= GATE**2 * (variance + LOOK_STD**2) and np.abs(hue).max() <= HUE_MAX
    kept = math.exp(-passed / TRUST_S)
    log = drift.log
    if agrees:
        gain = variance / (variance + LOOK_STD**2)
        log = float(np.clip(log + gain * change, -LOG_MAX, LOG_MAX))
        variance *= 1.0 - gain
    believed = agrees and abs(log) < LOG_MAX
    trust = kept * drift.trust + (1.0 - kept) * believed
    doubtful = trust < (SURE_ABOVE if drift.doubtful else DOUBT_BELOW)
    drift = replace(drift, log=log, variance=variance, trust=trust, doubtful=doubtful)
    if abs(log - drift.lit_log) < QUANTUM:
        return drift
    return replace(drift, lit=relit(drift.learnt, math.exp(log)), lit_log=log)


def relit(model: ColourModel, factor: float) -> ColourModel:
    """The same model where every encoded colour is `factor` times as bright and as coloured."""
    mean, covariance = _scaled(model.mean, model.covariance, factor)
    if isinstance(model, ColourTable):
        before = (cell_colours().reshape(-1, 3) - _NO_COLOUR) / factor + _NO_COLOUR
        table = unpacked(model.table)[cells_of(before.astype(np.float32))]
        return ColourTable(mean=mean, covariance=covariance, table=packed(table, level=1))
    if isinstance(model, ColourMixture):
        components = tuple(
            Component(one.weight, *_scaled(one.mean, one.covariance, factor))
            for one in model.components
        )
        return ColourMixture(mean=mean, covariance=covariance, components=components)
    return ColourModel(mean=mean, covariance=covariance)


def _scaled(
    mean: Triple, covariance: tuple[Triple, Triple, Triple], factor: float
) -> tuple[Triple, tuple[Triple, Triple, Triple]]:
    y, u, v = (factor * (np.array(mean) - _NO_COLOUR) + _NO_COLOUR).tolist()
    # shadows are as noisy as they were: what is darker is not surer
    wider = max(factor, 1.0) ** 2
    rows = [(wider * a, wider * b, wider * c) for a, b, c in covariance]
    return (y, u, v), (rows[0], rows[1], rows[2])
