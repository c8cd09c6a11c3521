"""How likely a reading of an outline is before the outline is looked at, by another way."""

import numpy as np
import pytest
from raster import BOARD, CAN, board_pose, can_pose

from naod.bench.frames import Walk, WalkSettings
from naod.config import SegmentationConfig
from naod.finding.find import find_object
from naod.finding.hue import Colours
from naod.geometry.camera import nominal_camera
from naod.perception.learning import learn_model
from naod.perception.segmenter import Segmenter
from naod.pose.contour import figures
from naod.pose.explore import TILT_STD_RAD, unlikeliness
from naod.pose.locate import locate


@pytest.mark.parametrize("tilt", [-1.2, -0.4, 0.0, 0.7, 1.3])
@pytest.mark.parametrize("place", [(0.0, 0.0, 0.6), (0.2, -0.1, 0.8)])
def test_a_tilt_is_what_the_axis_lacks_of_a_right_angle_to_the_line_of_sight(place, tilt):
    T = can_pose(place, tilt, 0.3)
    axis, sight = T[:3, 1], T[:3, 3] / np.linalg.norm(T[:3, 3])
    seen = np.pi / 2.0 - np.arctan2(np.linalg.norm(np.cross(axis, sight)), abs(axis @ sight))
    said = unlikeliness(figures(CAN)[0], np.ascontiguousarray(T[:3]))
    assert said == pytest.approx(((np.pi / 2.0 - abs(seen - np.pi / 2.0)) / TILT_STD_RAD) ** 2)


def test_a_board_may_be_turned_as_it_likes():
    T = board_pose((0.0, 0.0, 1.0), 0.9, 0.5)
    assert unlikeliness(figures(BOARD)[0], np.ascontiguousarray(T[:3])) == 0.0


def test_a_blurred_can_before_a_strip_of_nearly_its_colour_keeps_its_size():
    """An orange bar, a little wider than the can behind it, once passed for the can's sides."""
    sequence = Walk(WalkSettings(count=2, seed=11)).taken("blurred", 0.020)
    camera, settings = nominal_camera("v6", 640, 480), SegmentationConfig()
    model = learn_model([sequence.shown], sequence.region)
    segmenter = Segmenter(model, settings, (640, 480))
    for frame in sequence.frames:
        found = find_object(
            segmenter.segment(frame.yuyv), sequence.shape, camera, None, settings, 13.0,
            Colours(frame.yuyv, model),
        )  # fmt: skip
        pose = locate(frame.yuyv, found.blob, sequence.shape, camera)
        true_m = np.linalg.norm(frame.T_camera_object[:3, 3])
        assert np.linalg.norm(pose.T_camera_object[:3, 3]) == pytest.approx(true_m, rel=0.02)
