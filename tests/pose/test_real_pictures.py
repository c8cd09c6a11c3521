"""Real masks and pictures with known poses; `../shared/data/<folder>/SOURCE.txt` says whence."""

from pathlib import Path

import numpy as np
import pytest

from naod.bench.known_poses import chessboard, coffee_can
from naod.bench.real import FOLDER_VARIABLE
from naod.pose.locate import locate_mask

DATA = Path(__file__).parents[2] / "../shared/data"
CHI2_95_OF_3 = 7.81
CLOSE = np.cos(np.radians(2.0))


@pytest.fixture(autouse=True)
def photographs(monkeypatch):
    monkeypatch.setenv(FOLDER_VARIABLE, str(DATA))


def error_of(pose, view):
    """Relative, and squared over its variance."""
    place = view.T_camera_object[:3, 3]
    gap = pose.T_camera_object[:3, 3] - place
    normalised = gap @ np.linalg.solve(pose.covariance[:3, :3], gap)
    return np.linalg.norm(gap) / np.linalg.norm(place), normalised


def test_coffee_can_from_its_mask():
    views = coffee_can()
    if not views:
        pytest.skip("needs ../shared/data/ycbv_0001")
    assert len(views) == 3
    for view in views:
        pose = locate_mask(view.mask, view.shape, view.camera)
        error, normalised = error_of(pose, view)
        assert error < 0.015
        assert normalised < CHI2_95_OF_3
        assert abs(pose.T_camera_object[:3, 1] @ view.T_camera_object[:3, 1]) > CLOSE
        assert pose.clipped == (("bottom",) if view.mask[-1].any() else ())


def test_chessboard_from_masks_drawn_around_its_detected_corners():
    views = chessboard()
    if not views:
        pytest.skip("needs ../shared/data/opencv_chessboard")
    assert len(views) >= 10
    errors, normalised = [], []
    for view in views:
        pose = locate_mask(view.mask, view.shape, view.camera)
        error, squared = error_of(pose, view)
        errors.append(error)
        normalised.append(squared)
        # which way is up is a matter of 180 degrees: the face and the long side are not
        for axis in (0, 2):
            assert abs(pose.T_camera_object[:3, axis] @ view.T_camera_object[:3, axis]) > CLOSE
    assert max(errors) < 0.015
    assert np.mean(np.array(normalised) < CHI2_95_OF_3) >= 0.9
