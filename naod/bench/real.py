"""Photographs with masks that somebody else made, where they lie beside the project."""

from __future__ import annotations

import importlib.util
import os
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from hal.yuyv import yuv_from_rgb, yuyv_from_rgb
from naod.bench.frames import Frame, Sequence, marked_region
from naod.perception.colour_model import Region

FOLDER_VARIABLE = "NAOD_BENCH_DATA"
DEFAULT_FOLDER = "../shared/data"


WALK_REGION = Region(60, 320, 160, 360)
"""The yellow chair's back in the first picture of the walk."""


SUFFIXES = (".jpg", ".jpeg", ".png")
LEAST_SIZE = (320, 240)
COLOURS_MIN = 100
"""Of sixteen levels each of red, green and blue: a grey picture has sixteen."""


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


def coloured_photographs() -> dict[str, NDArray[np.uint8]]:
    """(H, W, 3) uint8 YUV by name: the first picture of each folder, and scikit-learn's two.

    Masks and grey pictures have too few colours, small ones are no photographs.
    """
    found: dict[str, NDArray[np.uint8]] = {}
    for path in sorted(photographs().rglob("*")):
        folder = str(path.parent.relative_to(photographs()))
        if path.suffix in SUFFIXES and folder not in found:
            bgr = cv2.imread(str(path))
            if bgr is not None and _is_photograph(np.asarray(bgr)):
                found[folder] = _yuv(_rgb(np.asarray(bgr)))
    if importlib.util.find_spec("sklearn") is not None:
        from sklearn.datasets import load_sample_images

        samples = load_sample_images()
        found |= {
            Path(name).stem: _yuv(np.asarray(rgb))
            for name, rgb in zip(samples.filenames, samples.images, strict=True)
        }
    return found


def _is_photograph(bgr: NDArray[np.generic]) -> bool:
    if bgr.shape[0] < LEAST_SIZE[1] or bgr.shape[1] < LEAST_SIZE[0]:
        return False
    coarse = (bgr[::2, ::2].astype(np.int32) // 16).reshape(-1, 3) @ (256, 16, 1)
    return bool(np.count_nonzero(np.bincount(coarse) > 2) > COLOURS_MIN)


def _yuv(rgb: NDArray[np.uint8]) -> NDArray[np.uint8]:
    levels = np.rint(yuv_from_rgb(rgb.astype(np.float32)))
    return np.clip(levels, 0.0, 255.0).astype(np.uint8)


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
