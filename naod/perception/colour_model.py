"""The object's colour: one Gaussian in YUV, learnt from regions a person marks (paper 3.1, 5.1)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Literal

import msgspec
import numpy as np
from numpy.typing import NDArray

from hal.yuyv import yuv_from_yuyv
from naod.errors import InputError
from naod.files import parse_toml, read_text, write_toml
from naod.perception.colour_table import unpacked

Triple = tuple[float, float, float]

PIXELS_MIN = 16
"""A covariance of three channels from fewer pixels says nothing."""

STD_FLOOR = 3.0
"""Least standard deviation along any direction, 8-bit levels: sensor noise is never below it."""


class Region(msgspec.Struct, frozen=True):
    """A rectangle of pixels: left column, upper row, width, height."""

    x: int
    y: int
    width: int
    height: int


class ColourModel(
    msgspec.Struct,
    frozen=True,
    kw_only=True,
    forbid_unknown_fields=True,
    tag_field="kind",
    tag="gaussian",
):
    """`mean` of Y, U, V in 8-bit levels; `covariance` in levels squared, 3x3, full rank."""

    mean: Triple
    covariance: tuple[Triple, Triple, Triple]


class ColourTable(ColourModel, frozen=True, kw_only=True, tag="table"):
    """The Gaussian, and beside it the table of `naod.perception.colour_table` as its text."""

    table: str


class Component(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One Gaussian of a mixture; the weights sum to 1."""

    weight: Annotated[float, msgspec.Meta(gt=0.0, le=1.001)]
    mean: Triple
    covariance: tuple[Triple, Triple, Triple]


class ColourMixture(ColourModel, frozen=True, kw_only=True, tag="mixture"):
    """The Gaussian of all, and beside it those of `naod.perception.mixture`."""

    components: Annotated[tuple[Component, ...], msgspec.Meta(min_length=1, max_length=32)]


class _Kind(msgspec.Struct, frozen=True):
    kind: Literal["gaussian", "mixture", "table"] = "gaussian"


_TYPES: dict[str, type[ColourModel]] = {
    "gaussian": ColourModel,
    "mixture": ColourMixture,
    "table": ColourTable,
}


def learn(frames: Sequence[NDArray[np.uint8]], region: Region) -> ColourModel:
    """The colour inside `region` of every frame.

    Frames are YUYV (H, W, 2) or YUV (H, W, 3), uint8. The mean is that of all frames; the
    covariance is that of single-frame pixels about it, not of averaged frames, because single
    pixels are what segmentation meets. Its eigenvalues are at least STD_FLOOR squared. Raises
    InputError when the region is outside a frame, too small, or one value throughout.
    """
    if not frames:
        raise InputError("no frame to learn the colour from")
    pixels = np.concatenate([region_pixels(frame, region) for frame in frames])
    if (pixels == pixels[0]).all():
        y, u, v = (int(c) for c in pixels[0])
        raise InputError(
            f"region {_text(region)}: every pixel is the same, YUV ({y}, {u}, {v}); "
            "a blank or saturated area has no colour to learn"
        )
    covariance = np.cov(pixels.astype(np.float64), rowvar=False)
    values, vectors = np.linalg.eigh(covariance)
    floored = (vectors * np.maximum(values, STD_FLOOR**2)) @ vectors.T
    return model_of(pixels.mean(axis=0, dtype=np.float64), floored)


def model_of(mean: NDArray[np.float64], covariance: NDArray[np.float64]) -> ColourModel:
    """The struct from arrays (3,) and (3, 3)."""
    rows = [(float(a), float(b), float(c)) for a, b, c in (covariance + covariance.T) / 2.0]
    y, u, v = (float(c) for c in mean)
    return ColourModel(mean=(y, u, v), covariance=(rows[0], rows[1], rows[2]))


def load_model(path: Path) -> ColourModel:
    """Read MODEL.toml; one without `kind` is a Gaussian.

    Raises InputError that names the file and what is wrong.
    """
    text = read_text(path)
    model = parse_toml(text, _TYPES[parse_toml(text, _Kind, str(path)).kind], str(path))
    _check(model, path)
    for component in model.components if isinstance(model, ColourMixture) else ():
        _check(component, path)
    if isinstance(model, ColourTable):
        try:
            unpacked(model.table)
        except InputError as error:
            raise InputError(f"{path}: {error}") from None
    return model


def _check(one: ColourModel | Component, path: Path) -> None:
    """Raises InputError where it is no Gaussian."""
    values = np.array([one.mean, *one.covariance])
    covariance = values[1:]
    if not np.isfinite(values).all():
        raise InputError(f"{path}: mean and covariance must be finite")
    if not np.allclose(covariance, covariance.T, rtol=1e-6, atol=1e-6):
        raise InputError(f"{path}: covariance is not symmetric")
    if np.linalg.eigvalsh(covariance)[0] <= 0.0:
        raise InputError(f"{path}: covariance is not positive definite")


def save_model(path: Path, model: ColourModel) -> None:
    """Write MODEL.toml, whole or not at all. Raises InputError."""
    write_toml(path, model)


def region_pixels(frame: NDArray[np.uint8], region: Region) -> NDArray[np.uint8]:
    """(n, 3) YUV of a region of a YUYV (H, W, 2) or YUV (H, W, 3) frame. Raises InputError."""
    height, width = frame.shape[:2]
    x, y, right, bottom = region.x, region.y, region.x + region.width, region.y + region.height
    if region.width < 1 or region.height < 1 or region.width * region.height < PIXELS_MIN:
        raise InputError(f"region {_text(region)}: needs at least {PIXELS_MIN} pixels")
    if x < 0 or y < 0 or right > width or bottom > height:
        raise InputError(f"region {_text(region)}: outside the {width}x{height} picture")
    if frame.shape[2] == 3:
        return frame[y:bottom, x:right].reshape(-1, 3)
    # whole pairs, which share their chroma
    left = x - x % 2
    pairs = yuv_from_yuyv(frame[y:bottom, left : right + right % 2])
    return pairs[:, x - left : right - left].reshape(-1, 3)


def _text(region: Region) -> str:
    return f"{region.x},{region.y},{region.width},{region.height}"
