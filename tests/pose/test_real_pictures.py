"""Real masks and pictures with known poses; `../shared/data/<folder>/SOURCE.txt` says whence."""

import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from naod.geometry.camera import PinholeCamera
from naod.pose.locate import locate_mask
from naod.pose.objects import Cylinder, Rectangle

DATA = Path(__file__).parents[2] / "../shared/data"
needs_ycbv = pytest.mark.skipif(
    not (DATA / "ycbv_0001").is_dir(), reason="needs ../shared/data/ycbv_0001"
)
needs_chessboard = pytest.mark.skipif(
    not (DATA / "opencv_chessboard").is_dir(), reason="needs ../shared/data/opencv_chessboard"
)
CAN = "002_master_chef_can"
CORNERS = (9, 6)
SQUARE_M = 0.025
BOARD = Rectangle(width_m=0.200, height_m=0.125)


def normalised_error(pose, place):
    gap = pose.T_camera_object[:3, 3] - place
    return gap @ np.linalg.solve(pose.covariance[:3, :3], gap)


CHI2_95_OF_3 = 7.81


@needs_ycbv
@pytest.mark.parametrize("frame", ["0001/000001", "0001/000004", "0001/000005"])
def test_coffee_can_from_its_mask(frame):
    truth = json.loads((DATA / "ycbv_0001/truth.json").read_text())
    extent = {k: np.array(v) for k, v in truth["model_extent_m"][CAN].items()}
    size = extent["max"] - extent["min"]
    can = Cylinder(radius_m=float(size[:2].mean() / 2.0), height_m=float(size[2]))
    K = truth["frames"][frame]["K"]
    camera = PinholeCamera(width=640, height=480, fx=K[0][0], fy=K[1][1], cx=K[0][2], cy=K[1][2])
    T = np.array(truth["frames"][frame]["objects"][CAN]["pose_o2c"])
    place = T[:, :3] @ (extent["max"] + extent["min"]) / 2.0 + T[:, 3]
    label = cv2.imread(str(DATA / f"ycbv_0001/{frame}-label.png"), cv2.IMREAD_UNCHANGED)
    pose = locate_mask((label == 1).astype(np.uint8), can, camera)
    assert np.linalg.norm(pose.T_camera_object[:3, 3] - place) < 0.015 * np.linalg.norm(place)
    assert normalised_error(pose, place) < CHI2_95_OF_3
    assert abs(pose.T_camera_object[:3, 1] @ T[:, 2]) > np.cos(np.radians(2.0))
    assert pose.clipped == (("bottom",) if frame != "0001/000005" else ())


def chessboard_camera():
    file = cv2.FileStorage(
        str(DATA / "opencv_chessboard/left_intrinsics.yml"), cv2.FILE_STORAGE_READ
    )
    K = file.getNode("camera_matrix").mat()
    bent = file.getNode("distortion_coefficients").mat().ravel()
    camera = PinholeCamera(
        width=640,
        height=480,
        fx=K[0, 0],
        fy=K[1, 1],
        cx=K[0, 2],
        cy=K[1, 2],
        distortion=tuple(float(k) for k in bent),
    )
    return camera, file.getNode("extrinsic_parameters").mat()


def rim_of(grid):
    """Outer rim of a grid (rows, columns, 2) of corners, once around."""
    return np.concatenate([grid[0, :-1], grid[:-1, -1], grid[-1, :0:-1], grid[:0:-1, 0]])


@needs_chessboard
def test_chessboard_from_masks_drawn_around_its_detected_corners():
    camera, extrinsics = chessboard_camera()
    files = sorted((DATA / "opencv_chessboard").glob("left*.jpg"))
    errors, normalised = [], []
    for path, row in zip(files, extrinsics, strict=True):
        found, corners = cv2.findChessboardCorners(cv2.imread(str(path), 0), CORNERS)
        if not found:
            continue
        rim = rim_of(corners.reshape(CORNERS[1], CORNERS[0], 2))
        mask = np.zeros((480, 640), np.uint8)
        cv2.fillPoly(mask, [np.rint(rim * 256).astype(np.int32)], 1, shift=8)
        R, t = cv2.Rodrigues(row[:3])[0], row[3:]
        place = R @ np.array([BOARD.width_m / 2.0, BOARD.height_m / 2.0, 0.0]) + t
        pose = locate_mask(mask, BOARD, camera)
        errors.append(np.linalg.norm(pose.T_camera_object[:3, 3] - place) / np.linalg.norm(place))
        normalised.append(normalised_error(pose, place))
        # which way is up is a matter of 180 degrees: the face and the long side are not
        assert abs(pose.T_camera_object[:3, 2] @ R[:, 2]) > np.cos(np.radians(2.0))
        assert abs(pose.T_camera_object[:3, 0] @ R[:, 0]) > np.cos(np.radians(2.0))
    assert len(errors) >= 10
    assert max(errors) < 0.015
    assert np.mean(np.array(normalised) < CHI2_95_OF_3) >= 0.9
