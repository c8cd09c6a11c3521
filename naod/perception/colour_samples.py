"""What a picture in which the object is known says of colours that a moving camera will see.

The object is cut out and blurred over its surroundings, and over rooms made up, in several lights.
Colours that are mixed from object and background then count for whichever is the larger part.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import msgspec
import numpy as np
from numpy.typing import NDArray

from naod.perception.blurring import Layers, cut_out, motions, smeared, yuv_from_light
from naod.perception.colour_table import CELLS, cells_of
from naod.perception.encoding import LIGHT

Floats = NDArray[np.float32]
Mask = NDArray[np.bool_]
Counts = NDArray[np.float64]


class SampleSettings(msgspec.Struct, frozen=True):
    """What is tried.

    `blurs`: lengths of motion, relative to the side of a square of the object's area, and
    `blur_shares`, how often; `turns`: directions of each. `light_std`: of the logarithm of
    brightness. `ring`: width of the surroundings, relative to the same side. `samples_max`: pixels
    per motion. `shade_std`: as `light_std`, of the object's other sides. `elsewhere_max`: pixels of
    the rest of the picture.
    """

    blurs: tuple[float, ...] = (0.0, 0.3, 0.7)
    blur_shares: tuple[float, ...] = (0.4, 0.3, 0.3)
    turns: int = 4
    light_std: float = 0.27
    ring: float = 0.5
    samples_max: int = 3000
    shade_std: float = 0.7
    elsewhere_max: int = 4000


@dataclass(frozen=True, slots=True)
class Seen:
    """Shares of each cell (CELLS,), each sum 1.

    `object` and `around` as they are in front of the surroundings, `object_anywhere` and
    `anywhere` in rooms made up; `shades`: the object's in other light than its surroundings;
    `elsewhere`: the rest of this picture.
    """

    object: Counts
    object_anywhere: Counts
    shades: Counts
    around: Counts
    anywhere: Counts
    elsewhere: Counts


def sampled(
    light: Floats, inside: Mask, unsure: Mask, settings: SampleSettings, rng: np.random.Generator
) -> Seen:
    """Of a sharp picture in linear light (h, w, 3), what is object in it and what may be."""
    side = float(np.sqrt(np.count_nonzero(inside)))
    width = 2 * max(3, round(settings.ring * side)) + 3
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (width, width))
    zone = cv2.dilate(inside.astype(np.uint8), disc) > 0
    elsewhere = light[~(inside | unsure)]
    # no motion brings light from farther away
    near = _box_of(zone, round(max(settings.blurs) * side) + 2)
    zone, layers = zone[near], cut_out(light[near], inside[near], unsure[near])
    sharp = zone & ~unsure[near]
    sums = np.zeros((4, CELLS))
    for blur, share in zip(settings.blurs, settings.blur_shares, strict=True):
        turns = settings.turns if blur > 0.0 else 1
        for length, angle in motions((blur * side,), turns):
            places = np.flatnonzero(zone if blur > 0.0 else sharp)
            weight = share / turns
            if len(places) > settings.samples_max:
                weight *= len(places) / settings.samples_max
                places = rng.choice(places, settings.samples_max, replace=False)
            blurred = smeared(layers, length, angle)
            sums += weight * _counted(blurred, places, elsewhere, settings.light_std, rng)
    object_, beside, object_anywhere, anywhere = (_share(s) for s in sums)
    most = settings.elsewhere_max
    shades = _share(_cells_counted(light[inside], most, settings.shade_std, rng))
    rest = _share(_cells_counted(elsewhere, most, settings.light_std, rng))
    return Seen(object_, object_anywhere, shades, beside, anywhere, rest)


def _counted(
    layers: Layers,
    places: NDArray[np.int64],
    elsewhere: Floats,
    light_std: float,
    rng: np.random.Generator,
) -> Counts:
    """(4, CELLS) object and background before the surroundings, then both before anything else."""
    share = layers.share.ravel()[places]
    own, behind = (part.reshape(-1, 3)[places] for part in (layers.object, layers.behind))
    made_up = own + (1.0 - share[:, None]) * _rooms(len(places), elsewhere, rng)
    brightness = _brightness(len(places), light_std, rng)
    most = share >= 0.5
    counts = []
    for light in (own + behind, made_up):
        cells = cells_of(yuv_from_light(brightness * light))
        counts += [np.bincount(cells[part], minlength=CELLS) for part in (most, ~most)]
    return np.stack(counts).astype(np.float64)


def _cells_counted(light: Floats, most: int, light_std: float, rng: np.random.Generator) -> Counts:
    if len(light) > most:
        light = light[rng.integers(0, len(light), most)]
    cells = cells_of(yuv_from_light(_brightness(len(light), light_std, rng) * light))
    return np.bincount(cells, minlength=CELLS).astype(np.float64)


def _brightness(count: int, light_std: float, rng: np.random.Generator) -> Floats:
    return np.exp(light_std * rng.standard_normal((count, 1), dtype=np.float32))


def _rooms(count: int, elsewhere: Floats, rng: np.random.Generator) -> Floats:
    """Light (count, 3) of what may be behind: near greys, any colour, and this room's own."""
    greys = rng.uniform(0.0, 255.0, (count, 1)) + rng.normal(0.0, 12.0, (count, 3))
    colours = rng.uniform(0.0, 255.0, (count, 3))
    kind = rng.integers(0, 4 if len(elsewhere) else 2, count)
    levels = np.clip(np.where(kind[:, None] == 0, greys, colours), 0.0, 255.0)
    light = LIGHT.astype(np.float32)[levels.astype(np.uint8)]
    own = kind >= 2
    light[own] = elsewhere[rng.integers(0, max(len(elsewhere), 1), np.count_nonzero(own))]
    return light


def _share(counts: Counts) -> Counts:
    return counts / max(float(counts.sum()), 1.0)


def _box_of(mask: Mask, margin: int) -> tuple[slice, slice]:
    """Rows and columns that hold a mask and a margin around it, within the picture."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return (
        slice(max(int(rows[0]) - margin, 0), int(rows[-1]) + 1 + margin),
        slice(max(int(columns[0]) - margin, 0), int(columns[-1]) + 1 + margin),
    )
