"""The fit on synthetic views: recovers what made them, says how well, refuses what says nothing."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from synthetic import ASKEW, HEADS, LENS, SHAPE, rig, truth, views_of

from hal.types import HeadAngles
from naod.calibration.fit import (
    Expected,
    Problem,
    first_estimate,
    fit,
    sigma_deg,
    without_odd_views,
)
from naod.calibration.rig import HEADS as FIRST_HEAD
from naod.calibration.view import corners_in_object
from naod.errors import InputError

OFF = np.array([620.0, 620.5, 312.0, 246.0, 0.02])


def fitted(views, lens=LENS, known=False, model=None):
    model = model or rig()
    start = first_estimate(model, views, np.zeros(3), lens)
    return fit(Problem(model, SHAPE, views, Expected.of(lens, 640, known)), start)


def error_deg(found):
    return np.degrees(np.abs(found.estimate.correction_rad - ASKEW))


def test_exact_views_give_the_exact_camera():
    views = views_of(rig(), truth())
    found = fitted(views, known=True)
    assert error_deg(found).max() < 1e-3
    assert found.rms_px < 1e-3


def test_the_lens_is_found_from_a_wrong_one():
    lens = np.array([*LENS[:4], -0.05])
    views = views_of(rig(), truth(lens=lens))
    problem = Problem(rig(), SHAPE, views, Expected.of(OFF, 640, False))
    # next to nothing expected, so that the views alone decide
    problem.expected = replace(problem.expected, sigma=1e3 * problem.expected.sigma)
    found = fit(problem, first_estimate(rig(), views, np.zeros(3), OFF))
    assert np.allclose(found.estimate.lens[:4], lens[:4], atol=0.5)
    assert abs(found.estimate.lens[4] - lens[4]) < 2e-3
    assert error_deg(found).max() < 0.02


def test_opencv_finds_the_same_lens_from_the_corners():
    """An independent fit: free poses of the camera, no neck, no robot."""
    views = views_of(rig(), truth())
    corners = corners_in_object(SHAPE)
    pixels = [
        rig().pixels(truth(), head, n, corners)[0].astype(np.float32)
        for n, head in enumerate(HEADS)
    ]
    K = np.array([[OFF[0], 0.0, OFF[2]], [0.0, OFF[1], OFF[3]], [0.0, 0.0, 1.0]])
    flags = (
        cv2.CALIB_USE_INTRINSIC_GUESS
        | cv2.CALIB_FIX_K1 | cv2.CALIB_FIX_K2 | cv2.CALIB_FIX_K3
        | cv2.CALIB_ZERO_TANGENT_DIST
    )  # fmt: skip
    _, theirs, *_ = cv2.calibrateCamera(
        [corners.astype(np.float32)] * len(pixels), pixels, (640, 480), K, np.zeros(5), flags=flags
    )
    ours = fitted(views, lens=LENS).estimate.lens
    assert np.allclose(ours[:4], [theirs[0, 0], theirs[1, 1], theirs[0, 2], theirs[1, 2]], atol=1.0)


def test_noisy_views_are_right_within_what_is_stated():
    rng = np.random.default_rng(7)
    pulls, worst = [], 0.0
    for _ in range(8):
        views = views_of(rig(), truth(), HEADS, rng, noise_px=0.1, head_noise_rad=0.001)
        found = fitted(views)
        pulls.append((found.estimate.correction_rad - ASKEW) / np.radians(sigma_deg(found)))
        worst = max(worst, error_deg(found).max())
    assert worst < 0.3
    assert np.sqrt(np.mean(np.square(pulls))) < 1.3


def test_the_information_is_the_gradients_derivative():
    views = views_of(rig(), truth(), HEADS[:4])
    problem = Problem(rig(), SHAPE, views, Expected.of(LENS, 640, False))
    at = truth(heads=HEADS[:4])
    _, g, H = problem.system(at)
    for column in range(FIRST_HEAD + 8):
        step = np.zeros(FIRST_HEAD + 8)
        step[column] = 1e-6
        up, down = problem.system(at.moved(step))[1], problem.system(at.moved(-step))[1]
        scale = np.sqrt(np.diag(H) * H[column, column])
        assert np.allclose((up - down) / 2e-6 / scale, H[:, column] / scale, atol=2e-3), column
    assert np.abs(g / np.sqrt(np.diag(H))).max() < 1e-3


def test_a_view_that_does_not_belong_is_left_out():
    views = views_of(rig(), truth())
    elsewhere = views[4].edges.points_px + np.array([30.0, 12.0])
    moved = replace(views[4].edges, points_px=elsewhere)
    odd = [*views[:4], replace(views[4], edges=moved), *views[5:]]
    model = rig()
    start = first_estimate(model, odd, np.zeros(3), LENS)
    found, kept = without_odd_views(model, SHAPE, odd, Expected.of(LENS, 640, True), start)
    assert len(kept) == len(odd) - 1
    assert all(view is not odd[4] for view in kept)
    assert error_deg(found).max() < 1e-3


def test_views_that_are_alike_say_little():
    alike = [HeadAngles(0.01 * n, 0.0) for n in range(8)]
    views = views_of(rig(), truth(heads=alike), alike)
    assert sigma_deg(fitted(views)).max() > 1.0


def test_one_view_again_and_again_says_nothing():
    same = [HeadAngles(0.0, 0.0)] * 8
    views = views_of(rig(), truth(heads=same), same)
    with pytest.raises(InputError, match="too alike"):
        fitted(views)


@pytest.mark.parametrize("size", [1.1, 0.9])
def test_a_rectangle_of_another_shape_does_not_fit(size):
    views = views_of(rig(), truth())
    wrong = type(SHAPE)(width_m=SHAPE.width_m * size, height_m=SHAPE.height_m)
    start = first_estimate(rig(), views, np.zeros(3), LENS)
    found = fit(Problem(rig(), wrong, views, Expected.of(LENS, 640, False)), start)
    assert found.misfit > 3.0
