"""The object in walks of the benchmark, blurred, in a room never seen: found, or not there."""

import msgspec
import numpy as np
import pytest

from naod.bench.frames import Walk, WalkSettings
from naod.bench.room import UNSEEN
from naod.bench.score import LOST_BELOW, polygon_iou
from naod.config import SegmentationConfig
from naod.finding.find import find_object
from naod.finding.hue import Colours
from naod.geometry.camera import nominal_camera
from naod.perception.blob import blob_of_mask
from naod.perception.learning import learn_model
from naod.perception.segmenter import Segmenter

HOME = WalkSettings(count=6, seed=900)
ELSEWHERE = msgspec.structs.replace(HOME, seed=907, room=UNSEEN["other walls"])
EXPOSURE_S, SHORT_S = 0.033, 0.010
CAMERA = nominal_camera("v6", *HOME.size)
SETTINGS = SegmentationConfig()


@pytest.mark.parametrize("thing", ["can", "board"])
def test_found_where_it_is_and_nowhere_else(thing):
    home, there = (msgspec.structs.replace(room, thing=thing) for room in (HOME, ELSEWHERE))
    taught = Walk(msgspec.structs.replace(home, count=0)).taken("home", 0.0)
    model = learn_model([taught.shown], taught.region)
    segmenter = Segmenter(model, SETTINGS, home.size)
    walk = Walk(there)
    # who does not know how far a long exposure smears is less sure
    for exposure_s, known in ((EXPOSURE_S, True), (SHORT_S, True), (SHORT_S, False)):
        for frame in walk.taken("blurred", exposure_s).frames:
            blur_px = float(np.hypot(*frame.motion_px)) if known else 0.0
            truth = blob_of_mask(frame.mask)
            segmentation, colours = segmenter.segment(frame.yuyv), Colours(frame.yuyv, model)
            found = find_object(
                segmentation, taught.shape, CAMERA, None, SETTINGS, blur_px, colours
            )
            assert polygon_iou(found.blob.corners_px, truth.corners_px) > LOST_BELOW
    for frame in walk.without("absent", EXPOSURE_S).frames:
        segmentation = segmenter.segment(frame.yuyv)
        colours = Colours(frame.yuyv, model)
        found = find_object(segmentation, taught.shape, CAMERA, None, SETTINGS, colours=colours)
        assert found is None
