"""The object in walks of the benchmark, blurred, in a room never seen: found, or not there."""

import msgspec
import numpy as np
import pytest

from naod.bench.frames import Walk, WalkSettings
from naod.bench.room import UNSEEN
from naod.bench.score import LOST_BELOW, polygon_iou
from naod.config import SegmentationConfig
from naod.finding.find import find_object
from naod.geometry.camera import nominal_camera
from naod.perception.blob import blob_of_mask
from naod.perception.learning import learn_model
from naod.perception.segmenter import Segmenter

HOME = WalkSettings(count=6, seed=900)
ELSEWHERE = msgspec.structs.replace(HOME, seed=907, room=UNSEEN["other walls"])
EXPOSURE_S = 0.033
CAMERA = nominal_camera("v6", *HOME.size)
SETTINGS = SegmentationConfig()


@pytest.mark.parametrize("thing", ["can", "board"])
def test_found_where_it_is_and_nowhere_else(thing):
    home, there = (msgspec.structs.replace(room, thing=thing) for room in (HOME, ELSEWHERE))
    taught = Walk(msgspec.structs.replace(home, count=0)).taken("home", 0.0)
    model = learn_model([taught.shown], taught.region)
    segmenter = Segmenter(model, SETTINGS, home.size)
    walk = Walk(there)
    for frame in walk.taken("blurred", EXPOSURE_S).frames:
        blur_px = float(np.hypot(*frame.motion_px))
        truth = blob_of_mask(frame.mask)
        for known_px in (0.0, blur_px):
            segmentation = segmenter.segment(frame.yuyv)
            found = find_object(segmentation, taught.shape, CAMERA, None, SETTINGS, known_px)
            assert polygon_iou(found.blob.corners_px, truth.corners_px) > LOST_BELOW
    for frame in walk.without("absent", EXPOSURE_S).frames:
        segmentation = segmenter.segment(frame.yuyv)
        assert find_object(segmentation, taught.shape, CAMERA, None, SETTINGS) is None
