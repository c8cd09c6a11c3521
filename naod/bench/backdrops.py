"""`naod bench backdrops`: the object, learnt at home, before photographs of anything.

A rendered room has flat colours and things with straight edges. Photographs have textures, skin,
wood and flowers, and many have the object's very colour all around it.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import cv2
import msgspec
import numpy as np
from numpy.typing import NDArray

from naod.bench.frames import Backdrop, Frame, Walk, WalkSettings
from naod.bench.poses import Errors, add, whole
from naod.bench.real import FOLDER_VARIABLE, coloured_photographs
from naod.bench.room import Thing, object_of
from naod.bench.score import LOST_BELOW, polygon_iou
from naod.bench.table import Report
from naod.config import SegmentationConfig
from naod.errors import InputError
from naod.finding.find import find_object
from naod.finding.hue import Colours
from naod.geometry.camera import nominal_camera
from naod.perception.blob import blob_of_mask
from naod.perception.blurring import light_from_yuv
from naod.perception.colour_model import ColourModel
from naod.perception.learning import learn_model
from naod.perception.segmenter import Segmenter
from naod.pose.locate import locate
from naod.pose.objects import ObjectShape

EXPOSURES_S = (0.0, 0.033)
THINGS: tuple[Thing, ...] = ("can", "board")
FRAMES = 10
MARGIN = 1.15
"""A photograph is so much larger than the picture, and another part of it is in every one."""

COLUMNS = (
    "object, exposure",
    "frames",
    "found %",
    "lost %",
    "box IoU",
    "distance % median",
    "90th",
    "error²/sigma² median",
    "found absent %",
)
CHI2_50_OF_3 = 2.37
SETTINGS = SegmentationConfig()
Progress = Callable[[str], None]
Photographs = Mapping[str, NDArray[np.uint8]]


@dataclass(slots=True)
class Tally:
    """Over frames that show the whole object, and those of the photographs alone."""

    boxes: list[float] = field(default_factory=list)
    found: int = 0
    errors: Errors = field(default_factory=Errors)
    absent: list[bool] = field(default_factory=list)


def run(
    progress: Progress,
    settings: WalkSettings | None = None,
    photographs: Photographs | None = None,
    things: tuple[Thing, ...] = THINGS,
) -> Report:
    """Every object before every photograph, sharp and blurred.

    photographs: (H, W, 3) uint8 YUV by name; those there are unless given. Raises InputError when
    there are none.
    """
    settings = settings or WalkSettings(count=FRAMES)
    if photographs is None:
        photographs = coloured_photographs()
    if not photographs:
        raise InputError(f"no photographs: {FOLDER_VARIABLE} names the folder they are in")
    rows = []
    for thing in things:
        walk = Walk(msgspec.structs.replace(settings, thing=thing))
        shown, region = walk.shown()
        model = learn_model([shown], region)
        for exposure in EXPOSURES_S:
            tally = Tally()
            for name, yuv in photographs.items():
                progress(f"{thing} at {1e3 * exposure:.0f} ms before {name}")
                backdrop = backdrop_of(yuv, settings.size)
                for absent in (False, True):
                    frames = walk.before(exposure, backdrop, absent)
                    measure(frames, model, object_of(thing), tally)
            rows.append((f"{thing}, {1e3 * exposure:.0f} ms", *_figures(tally)))
    notes = (
        f"{len(photographs)} photographs, learnt in the room at home; box IoU: median, a frame "
        "without a box counting 0",
        f"error²/sigma²: of the position, {CHI2_50_OF_3} when sigma is honest",
    )
    return Report("backdrops", COLUMNS, tuple(rows), notes)


def backdrop_of(yuv: NDArray[np.uint8], size: tuple[int, int]) -> Backdrop:
    """A photograph (H, W, 3) that fills pictures of a size (width, height), cut in turn."""
    width, height = size
    large = _covering(yuv, math.ceil(MARGIN * width), math.ceil(MARGIN * height))

    def part(n: int) -> NDArray[np.float32]:
        rng = np.random.default_rng(n)
        y = int(rng.integers(0, large.shape[0] - height + 1))
        x = int(rng.integers(0, large.shape[1] - width + 1))
        return light_from_yuv(large[y : y + height, x : x + width].astype(np.float32))

    return part


def _covering(yuv: NDArray[np.uint8], width: int, height: int) -> NDArray[np.uint8]:
    scale = max(width / yuv.shape[1], height / yuv.shape[0])
    size = (math.ceil(scale * yuv.shape[1]), math.ceil(scale * yuv.shape[0]))
    how = cv2.INTER_AREA if scale < 1.0 else cv2.INTER_CUBIC
    return np.asarray(cv2.resize(yuv, size, interpolation=how), dtype=np.uint8)


def measure(
    frames: tuple[Frame, ...], model: ColourModel, shape: ObjectShape, tally: Tally
) -> None:
    """Add what is found in frames and how well; those that cut the object off do not count."""
    height, width = frames[0].yuyv.shape[:2]
    camera = nominal_camera("v6", width, height)
    segmenter = Segmenter(model, SETTINGS, (width, height))
    for frame in frames:
        blur_px = math.hypot(*frame.motion_px)
        found = find_object(
            segmenter.segment(frame.yuyv), shape, camera, None, SETTINGS, blur_px,
            Colours(frame.yuyv, model),
        )  # fmt: skip
        if frame.T_camera_object is None:
            tally.absent.append(found is not None)
            continue
        truth = None if frame.mask is None else blob_of_mask(frame.mask)
        if truth is None or not whole(shape, frame.T_camera_object, camera):
            continue
        box = 0.0 if found is None else polygon_iou(found.blob.corners_px, truth.corners_px)
        tally.boxes.append(box)
        tally.found += found is not None
        if found is None:
            continue
        pose = locate(frame.yuyv, found.blob, shape, camera, exposure_s=frame.exposure_s)
        if pose is not None:
            add(tally.errors, pose, frame, shape, camera)


def _figures(tally: Tally) -> tuple[float | int | None, ...]:
    many, errors = len(tally.boxes), tally.errors
    if not many or not errors.distance:
        return (many, *(None,) * (len(COLUMNS) - 2))
    return (
        many,
        100.0 * tally.found / many,
        100.0 * float(np.mean([box < LOST_BELOW for box in tally.boxes])),
        statistics.median(tally.boxes),
        100.0 * statistics.median(errors.distance),
        100.0 * float(np.quantile(errors.distance, 0.9)),
        statistics.median(errors.normalised),
        100.0 * float(np.mean(tally.absent)),
    )
