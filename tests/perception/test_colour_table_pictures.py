"""Real pictures: the table keeps what one Gaussian finds, and finds what it cannot."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from hal.yuyv import yuyv_from_rgb
from naod.config import SegmentationConfig
from naod.perception.blob import find_blob
from naod.perception.colour_model import Region
from naod.perception.fullsize import full_mask
from naod.perception.learning import learn_model
from naod.perception.segmenter import Segmenter

DATA = Path(__file__).parents[2] / ".." / "shared" / "data"


def folder(name):
    if not (DATA / name).is_dir():
        pytest.skip(f"no pictures in ../shared/data/{name}")
    return DATA / name


def yuyv(path):
    return yuyv_from_rgb(cv2.imread(str(path))[..., ::-1])


def segmenter(frames, region, kind):
    size = (frames[0].shape[1], frames[0].shape[0])
    return Segmenter(learn_model(frames, region, kind), SegmentationConfig(), size)


def mask_iou(mask, truth):
    return np.count_nonzero((mask > 0) & truth) / np.count_nonzero((mask > 0) | truth)


@pytest.mark.parametrize("region", [Region(300, 130, 120, 200), Region(330, 200, 60, 80)])
def test_the_lemur(region):
    frame = yuyv(folder("lemur") / "lemur.png")
    truth = cv2.imread(str(DATA / "lemur" / "lemur_alpha.png"), 0) > 127
    ours = segmenter([frame], region, "table")
    mask = full_mask(ours, ours.segment(frame), frame)
    assert mask_iou(mask, truth) >= 0.95


def yellow(bgr):
    """The largest yellow region by hue, tuned by hand for these very pictures: a peer's answer."""
    hsv = cv2.cvtColor(cv2.GaussianBlur(bgr, (0, 0), 2), cv2.COLOR_BGR2HSV)
    inside = cv2.inRange(hsv, (21, 120, 60), (36, 255, 255))
    _, labels, stats, _ = cv2.connectedComponentsWithStats(inside)
    return labels == 1 + np.argmax(stats[1:, cv2.CC_STAT_AREA])


@pytest.mark.parametrize("region", [Region(60, 320, 160, 360), Region(100, 350, 60, 60)])
def test_the_chair_is_kept_on_every_picture_of_the_walk(region):
    pictures = [cv2.imread(str(path)) for path in sorted(folder("nao_walk").glob("*.jpg"))]
    frames = [yuyv_from_rgb(bgr[..., ::-1]) for bgr in pictures]
    table = segmenter(frames[:1], region, "table")
    for bgr, frame in zip(pictures, frames, strict=True):
        found = table.segment(frame)
        assert find_blob(found) is not None
        assert mask_iou(full_mask(table, found, frame), yellow(bgr)) > 0.94


def test_the_drifting_car_is_found_better_by_half():
    """The region has most of the car, windows and all: no one Gaussian has that."""
    pictures = sorted((folder("davis_drift") / "JPEGImages").glob("*.jpg"))
    frames = [yuyv(path) for path in pictures]
    means = {}
    for kind in ("table", "gaussian"):
        one = segmenter(frames[:1], Region(607, 202, 50, 50), kind)
        overlaps = []
        for path, frame in zip(pictures, frames, strict=True):
            marked = DATA / "davis_drift" / "Annotations" / f"{path.stem}.png"
            truth = cv2.imread(str(marked), 0) > 0
            overlaps.append(mask_iou(full_mask(one, one.segment(frame), frame), truth))
        means[kind] = np.mean(overlaps)
    assert means["table"] > 1.5 * means["gaussian"]
