"""Whatever the masks and pictures look like, there is a sound pose or none: never an error."""

import cv2
import numpy as np
import pytest
from raster import BOARD, CAMERA, CAN

from naod.perception.blob import blob_of_mask
from naod.pose.locate import locate, locate_mask
from naod.pose.objects import Cylinder

COIN = Cylinder(radius_m=0.1, height_m=0.01)


def noise(rng):
    return (rng.random((480, 640)) < rng.random()).astype(np.uint8)


def line(rng):
    mask = np.zeros((480, 640), np.uint8)
    ends = rng.integers(-50, 700, (2, 2))
    return cv2.line(mask, ends[0].tolist(), ends[1].tolist(), 1, int(rng.integers(1, 6)))


def polygon(rng):
    mask = np.zeros((480, 640), np.uint8)
    return cv2.fillPoly(mask, [rng.integers(-100, 750, (int(rng.integers(3, 9)), 2))], 1)


def speck(rng):
    mask = np.zeros((480, 640), np.uint8)
    x, y, w, h = rng.integers(1, 20, 4)
    mask[20 * y : 20 * y + h, 30 * x : 30 * x + w] = 1
    return mask


def clouds(rng):
    field = cv2.GaussianBlur(rng.random((480, 640)), (0, 0), rng.uniform(4, 30))
    return (field > np.quantile(field, rng.uniform(0.3, 0.99))).astype(np.uint8)


def check(pose):
    if pose is None:
        return
    T = pose.T_camera_object
    for array in (T, pose.covariance, pose.corners_px, pose.sigma_m):
        assert np.isfinite(array).all()
    assert np.allclose(T[:3, :3] @ T[:3, :3].T, np.eye(3), atol=1e-9)
    assert np.linalg.det(T[:3, :3]) > 0.0
    assert np.linalg.eigvalsh(pose.covariance).min() > -1e-9
    assert T[2, 3] > 0.0


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("kind", [noise, line, polygon, speck, clouds])
def test_a_sound_pose_or_none(kind):
    rng = np.random.default_rng(31)
    for k in range(6):
        mask = np.ascontiguousarray(kind(rng))
        yuyv = rng.integers(0, 256, (480, 640, 2), dtype=np.uint8)
        if k % 2:
            yuyv[mask > 0] = (80, 200)
        blob = blob_of_mask(mask)
        for shape in (CAN, BOARD, COIN):
            for estimator in ("exact", "paper"):
                check(locate_mask(mask, shape, CAMERA, estimator))
                if blob is not None:
                    check(locate(yuyv, blob, shape, CAMERA, estimator))
