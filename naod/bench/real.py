"""Photographs with masks that somebody else made, where they lie beside the project."""

from __future__ import annotations

import os
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from hal.yuyv import yuyv_from_rgb
from naod.bench.frames import Frame, Sequence, marked_region
from naod.perception.colour_model import Region

FOLDER_VARIABLE = "NAOD_BENCH_DATA"
DEFAULT_FOLDER = "../shared/data"


WALK_REGION = Region(60, 320, 160, 360)
"""The yellow chair's back in the first picture of the walk."""


def photographs() -> Path:
    """The folder they are in."""
    return Path(os.environ.get(FOLDER_VARIABLE, DEFAULT_FOLDER))


def robots_walk() -> Sequence | None:
    """A NAO walks up to a yellow chair, which is in every picture; nobody made masks."""
    files = sorted((photographs() / "nao_walk").glob("*.jpg"))
    pictures = [cv2.imread(str(path)) for path in files]
    frames = [Frame(yuyv_from_rgb(_rgb(np.asarray(p))), None) for p in pictures if p is not None]
    if not frames:
        return None
    return Sequence("NAO's walk", frames[0].yuyv, WALK_REGION, tuple(frames))


def real_sequences() -> list[Sequence]:
    """Those that are there: a lemur (two colours), a drifting car (blur, other cars' colours).

    Looked for in the folder that NAOD_BENCH_DATA names, else where the project's tests do.
    """
    folder = photographs()
    lemur = _pairs([(folder / "lemur/lemur.png", folder / "lemur/lemur_alpha.png")])
    drift = folder / "davis_drift"
    pictures = sorted((drift / "JPEGImages").glob("*.jpg"))
    car = _pairs([(p, drift / "Annotations" / f"{p.stem}.png") for p in pictures])
    found = []
    if lemur:
        found.append(_sequence("lemur", lemur, lemur))
    if len(car) > 1:
        found.append(_sequence("drift", car, car[1:]))
    return found


def _sequence(name: str, pairs: list[Frame], frames: list[Frame]) -> Sequence:
    """Marked in the first picture."""
    mask = pairs[0].mask
    assert mask is not None
    return Sequence(name, pairs[0].yuyv, marked_region(mask), tuple(frames))


def _pairs(paths: list[tuple[Path, Path]]) -> list[Frame]:
    frames = []
    for picture, mask in paths:
        if picture.is_file() and mask.is_file():
            bgr, alpha = cv2.imread(str(picture)), cv2.imread(str(mask), cv2.IMREAD_GRAYSCALE)
            if bgr is not None and alpha is not None:
                frames.append(_frame(np.asarray(bgr), np.asarray(alpha)))
    return frames


def _frame(bgr: NDArray[np.generic], alpha: NDArray[np.generic]) -> Frame:
    rgb = _rgb(bgr)
    inside = np.asarray(alpha[:, : rgb.shape[1]], dtype=np.uint8) > 127
    return Frame(yuyv_from_rgb(rgb), inside.astype(np.uint8))


def _rgb(bgr: NDArray[np.generic]) -> NDArray[np.uint8]:
    """An odd last column is left out: YUYV has pairs."""
    width = bgr.shape[1] - bgr.shape[1] % 2
    return np.ascontiguousarray(bgr[:, :width, ::-1], dtype=np.uint8)
