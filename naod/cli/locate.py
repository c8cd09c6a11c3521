"""`naod locate`: the object's pose from pictures, by our segmentation or given masks."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from naod.cli.output import Progress, print_json
from naod.cli.pictures import VIDEOS, Picture, find_files, read_image, read_pictures
from naod.cli.segment import Segmenters
from naod.errors import InputError
from naod.finding.find import find_object
from naod.finding.hue import Colours
from naod.geometry.camera import PinholeCamera, load_camera
from naod.perception.colour_model import load_model
from naod.pose.locate import locate, locate_mask
from naod.pose.objects import ObjectShape, load_object
from naod.pose.result import Estimator, ObjectPose

Locator = Callable[[Picture, "NDArray[np.uint8] | None"], "ObjectPose | None"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """INPUT... (--model MODEL.toml | --mask MASK...) --object OBJECT.toml --camera CAMERA.toml."""
    parser.add_argument("inputs", nargs="+", metavar="INPUT", help="pictures, folders or videos")
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--model", type=Path, metavar="MODEL.toml")
    source.add_argument("--mask", nargs="+", metavar="MASK", help="masks or folders, one per input")
    parser.add_argument("--object", required=True, type=Path, metavar="OBJECT.toml")
    parser.add_argument("--camera", required=True, type=Path, metavar="CAMERA.toml")
    parser.add_argument("--estimator", choices=("exact", "paper"), default="exact")
    parser.add_argument("--json", action="store_true", help="one JSON line per picture")


def run(args: argparse.Namespace) -> int:
    """Locate in everything, a line each."""
    shape, camera = load_object(args.object), load_camera(args.camera)
    locator = _locator(args, shape, camera)
    files = find_files(args.inputs)
    masks = None if args.mask is None else _mask_files(args.mask, files)
    progress = Progress("locating")
    warm = False
    for picture, mask in _pairs(read_pictures(files), masks):
        _check_size(picture, camera, args.camera)
        if not warm:
            # compiled or loaded before anything is timed
            locator(picture, mask)
            warm = True
        start = time.perf_counter()
        pose = locator(picture, mask)
        elapsed_ms = (time.perf_counter() - start) * 1e3
        if args.json:
            print_json(_line(picture, pose, args.estimator, elapsed_ms))
        else:
            print(_readable(picture, pose, elapsed_ms))
        progress.tick(picture.stem)
    progress.done()
    return 0


def _locator(args: argparse.Namespace, shape: ObjectShape, camera: PinholeCamera) -> Locator:
    estimator: Estimator = args.estimator
    if args.mask is not None:
        return lambda _, mask: None if mask is None else locate_mask(mask, shape, camera, estimator)
    segmenters = Segmenters(load_model(args.model))

    def with_model(picture: Picture, _: NDArray[np.uint8] | None) -> ObjectPose | None:
        segmenter = segmenters.of(picture)
        segmentation = segmenter.segment(picture.yuyv)
        colours = Colours(picture.yuyv, segmenter.model)
        found = find_object(segmentation, shape, camera, None, segmenter.settings, colours=colours)
        if found is None:
            return None
        return locate(picture.yuyv, found.blob, shape, camera, estimator)

    return with_model


def _mask_files(names: Sequence[str], files: Sequence[Path]) -> list[Path]:
    masks = find_files(names)
    pictures_only = all(path.suffix.lower() not in VIDEOS for path in files)
    if pictures_only and len(masks) != len(files):
        raise InputError(f"{len(files)} inputs but {len(masks)} masks: want one mask per input")
    return masks


def _pairs(
    pictures: Iterator[Picture], masks: list[Path] | None
) -> Iterator[tuple[Picture, NDArray[np.uint8] | None]]:
    """Each picture with its mask. Raises InputError where a video has more or fewer frames."""
    used = 0
    for picture in pictures:
        if masks is None:
            yield picture, None
            continue
        if used == len(masks):
            raise InputError(f"{picture.source}: has no mask, there are only {len(masks)}")
        yield picture, read_mask(masks[used], (picture.width, picture.height))
        used += 1
    if masks is not None and used != len(masks):
        raise InputError(f"{used} pictures but {len(masks)} masks: want one mask per picture")


def read_mask(path: Path, size: tuple[int, int]) -> NDArray[np.uint8]:
    """(H, W) uint8, 1 = object: what is brighter than half the brightest pixel.

    Raises InputError for another size than (width, height), and for a picture of several labels.
    """
    image = read_image(path, cv2.IMREAD_GRAYSCALE)
    if (image.shape[1], image.shape[0]) != size:
        raise InputError(
            f"{path}: the mask is {image.shape[1]}x{image.shape[0]}, "
            f"its picture {size[0]}x{size[1]}"
        )
    brightest = int(image.max())
    if brightest < 128 and len(np.unique(image)) > 2:
        raise InputError(f"{path}: holds several labels, want one object in white on black")
    return (image > brightest / 2.0).astype(np.uint8)


def _check_size(picture: Picture, camera: PinholeCamera, path: Path) -> None:
    if (picture.width, picture.height) != (camera.width, camera.height):
        raise InputError(
            f"{picture.source}: the picture is {picture.width}x{picture.height}, "
            f"{path} is for {camera.width}x{camera.height}"
        )


def _line(
    picture: Picture, pose: ObjectPose | None, estimator: Estimator, elapsed_ms: float
) -> dict[str, object]:
    return {
        "input": picture.source,
        "found": pose is not None,
        "T_camera_object": None if pose is None else pose.T_camera_object.tolist(),
        "sigma_m": None if pose is None else pose.sigma_m.tolist(),
        "sigma_rad": None if pose is None else pose.sigma_rad,
        "corners_px": None if pose is None else pose.corners_px.tolist(),
        "clipped": None if pose is None else list(pose.clipped),
        "estimator": estimator,
        "ms": round(elapsed_ms, 3),
    }


def _readable(picture: Picture, pose: ObjectPose | None, elapsed_ms: float) -> str:
    if pose is None:
        return f"{picture.source}: not found ({elapsed_ms:.1f} ms)"
    x, y, z = pose.T_camera_object[:3, 3]
    spread = 1e3 * float(np.linalg.norm(pose.sigma_m))
    cut = f", cut off at the {' and '.join(pose.clipped)}" if pose.clipped else ""
    return (
        f"{picture.source}: x {x:+.4f} y {y:+.4f} z {z:.4f} m +- {spread:.1f} mm{cut} "
        f"({elapsed_ms:.1f} ms)"
    )
