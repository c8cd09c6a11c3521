"""`naod segment`: masks from pictures, folders or a video."""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from naod.cli.output import Progress, print_json
from naod.cli.pictures import Picture, find_files, read_pictures
from naod.cli.segment_classes import segment_classes
from naod.config import SegmentationConfig
from naod.errors import InputError
from naod.files import write_whole
from naod.finding.find import Candidate, likeliest
from naod.finding.hue import Colours
from naod.perception.colour_model import ColourModel, load_model
from naod.perception.fullsize import full_mask
from naod.perception.segmenter import Segmentation, Segmenter


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """INPUT... (--model MODEL.toml | --unsupervised N) [--out DIR] [--json]."""
    parser.add_argument("inputs", nargs="+", metavar="INPUT", help="pictures, folders or videos")
    how = parser.add_mutually_exclusive_group(required=True)
    how.add_argument("--model", type=Path, metavar="MODEL.toml")
    how.add_argument(
        "--unsupervised",
        type=_count,
        metavar="N",
        help="no learnt colour: N classes, estimated together with their colours",
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="write masks there, 255 = object")
    parser.add_argument("--json", action="store_true", help="one JSON line per picture")


def _count(text: str) -> int:
    """Two to eight classes. Raises ArgumentTypeError."""
    if text not in {str(n) for n in range(2, 9)}:
        raise argparse.ArgumentTypeError(f"{text!r}: want a number of classes, 2 to 8")
    return int(text)


class Segmenters:
    """One segmenter per size of picture, its kernels warm before the first one is timed."""

    def __init__(self, model: ColourModel) -> None:
        self._model = model
        self._settings = SegmentationConfig()
        self._by_size: dict[tuple[int, int], Segmenter] = {}

    def of(self, picture: Picture) -> Segmenter:
        """The segmenter for a picture's size."""
        size = picture.padded_size
        if size not in self._by_size:
            segmenter = Segmenter(self._model, self._settings, size)
            seen(segmenter, picture)
            self._by_size[size] = segmenter
        return self._by_size[size]


def seen(segmenter: Segmenter, picture: Picture) -> tuple[Segmentation, Candidate | None]:
    """Labels of a picture and what in it is likeliest the object, by its colours alone."""
    segmentation = segmenter.segment(picture.yuyv)
    colours = Colours(picture.yuyv, segmenter.model)
    pixels_min = segmenter.settings.pixels_min
    return segmentation, likeliest(segmentation, None, None, None, pixels_min, colours=colours)


def run(args: argparse.Namespace) -> int:
    """Segment everything, a line each."""
    segmenters = Segmenters(load_model(args.model)) if args.model is not None else None
    files = find_files(args.inputs)
    if args.out is not None:
        _spare_inputs(files, args.out)
    progress = Progress("segmenting")
    for picture in read_pictures(files):
        if segmenters is None:
            line, mask = segment_classes(picture, args.unsupervised)
        else:
            line, mask = _segment(segmenters.of(picture), picture)
        if args.out is not None:
            png = cv2.imencode(".png", mask)[1].tobytes()
            write_whole(args.out / f"{picture.stem}.png", png)
        if args.json:
            print_json(line)
        else:
            print(_readable(line))
        progress.tick(picture.stem)
    progress.done()
    return 0


def _spare_inputs(files: list[Path], out: Path) -> None:
    """Raises InputError where a mask would take the place of its own picture."""
    for path in files:
        if (out / f"{path.stem}.png").resolve() == path.resolve():
            raise InputError(f"--out {out}: the mask of {path} would replace it")


def _segment(segmenter: Segmenter, picture: Picture) -> tuple[dict[str, object], NDArray[np.uint8]]:
    start = time.perf_counter()
    segmentation, best = seen(segmenter, picture)
    elapsed = time.perf_counter() - start
    labels = full_mask(segmenter, segmentation, picture.yuyv)[:, : picture.width]
    line: dict[str, object] = {
        "input": picture.source,
        "found": best is not None and best.probability >= segmenter.settings.presence_min,
        "pixels": int(np.count_nonzero(labels)),
        "energy": segmentation.energy,
        "iterations": segmentation.iterations,
        "ms": round(elapsed * 1e3, 3),
        "probability": round(best.probability if best else 0.0, 4),
    }
    return line, np.ascontiguousarray(labels * np.uint8(255))


def _readable(line: dict[str, object]) -> str:
    found = "found" if line["found"] else "not found"
    return (
        f"{line['input']}: {found}, {line['pixels']} pixels, energy {line['energy']:.0f}, "
        f"{line['iterations']} iterations, {line['ms']} ms"
    )
