"""The pose at a glance, on masks of true shapes (raster.py)."""

import cv2
import numpy as np
import pytest
from raster import BOARD, CAMERA, CAN, board_pose, can_pose, coverage, mask_of

from naod.geometry.camera import PinholeCamera
from naod.perception.blob import blob_of, blob_of_mask
from naod.perception.components import components
from naod.pose.coarse import coarse_fit
from naod.pose.lens import from_pixel, lens_of, to_pixel
from naod.pose.prior import Prior

CASES = [
    (CAN, can_pose((0.05, 0.02, 0.7), 0.3, 0.1)),
    (CAN, can_pose((-0.05, -0.03, 1.1), 0.5)),
    (BOARD, board_pose((0.1, -0.05, 1.2), 0.3, -0.5, 0.2)),
    (BOARD, board_pose((0.0, 0.05, 0.9), 0.1, 0.2)),
]
REDUCED = 4


def reduced_blob(shape, T):
    """The blob of a mask as segmentation at 160 columns gives it."""
    covered = coverage(shape, T)
    small = covered.reshape(480 // REDUCED, REDUCED, 640 // REDUCED, REDUCED).mean(axis=(1, 3))
    labels, table = components((small > 0.5).astype(np.uint8))
    wanted = np.ones(len(table) + 1, dtype=np.bool_)
    wanted[0] = False
    return blob_of(labels, table, wanted, float(REDUCED)), covered.sum()


@pytest.mark.parametrize(("shape", "T"), CASES)
def test_a_few_percent_from_a_mask_of_coarse_pixels(shape, T):
    blob, area = reduced_blob(shape, T)
    fit = coarse_fit(blob, shape, CAMERA)
    distance = np.linalg.norm(T[:3, 3])
    assert np.linalg.norm(fit.T_camera_object[:3, 3] - T[:3, 3]) < 0.03 * distance
    assert fit.misfit_grains2 < 0.15
    assert fit.support > 0.85
    assert fit.area_px == pytest.approx(area, rel=0.06)


@pytest.mark.parametrize(("shape", "T"), CASES)
def test_a_prior_near_by_is_followed_and_a_wrong_one_is_not(shape, T):
    blob, _ = reduced_blob(shape, T)
    near, wrong = T.copy(), T.copy()
    near[:3, 3] *= 1.05
    wrong[:3, 3] = (0.3, 0.2, 2.5)
    for hint in (near, wrong):
        fit = coarse_fit(blob, shape, CAMERA, Prior(hint, np.eye(6), 0.1))
        assert np.linalg.norm(fit.T_camera_object[:3, 3] - T[:3, 3]) < 0.04 * T[2, 3]


def test_something_else_shows_in_misfit_support_or_area():
    star = np.zeros((480, 640), np.uint8)
    angles = np.arange(10) * np.pi / 5
    radii = np.where(np.arange(10) % 2, 45.0, 130.0)
    points = np.column_stack([320 + radii * np.cos(angles), 240 + radii * np.sin(angles)])
    cv2.fillPoly(star, [points.astype(np.int32)], 1)
    for shape in (CAN, BOARD):
        fit = coarse_fit(blob_of_mask(star), shape, CAMERA)
        assert fit is None or fit.support < 0.5


def test_the_area_of_a_clipped_board_is_what_the_picture_shows():
    T = board_pose((-0.30, 0.0, 0.8), 0.2, 0.3)
    mask = mask_of(BOARD, T)
    fit = coarse_fit(blob_of_mask(mask), BOARD, CAMERA)
    assert fit.area_px == pytest.approx(mask.sum(), rel=0.02)


def test_the_kernels_lens_is_opencvs():
    bent = (-0.27, -0.04, 0.0018, -0.0003, 0.24)
    camera = PinholeCamera(
        width=640, height=480, fx=536.0, fy=530.0, cx=342.0, cy=235.0, distortion=bent
    )
    rng = np.random.default_rng(0)
    points = np.column_stack([rng.uniform(-0.5, 0.5, (20, 2)), np.ones(20)])
    lens, seen = lens_of(camera), camera.project(points)
    for point, pixel in zip(points, seen, strict=True):
        assert np.allclose(to_pixel(lens, point[0], point[1]), pixel, atol=1e-9)
        assert np.allclose(from_pixel(lens, pixel[0], pixel[1]), point[:2], atol=1e-8)
