"""Photographs whose poses somebody else measured, where they lie beside the project."""

from __future__ import annotations

import json
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from naod.bench.real import photographs
from naod.geometry.camera import PinholeCamera
from naod.pose.objects import Cylinder, ObjectShape, Rectangle

CAN, CAN_LABEL = "002_master_chef_can", 1
CORNERS, SQUARE_M = (9, 6), 0.025
"""Inner corners of the chessboard, along its long and its short side."""


@dataclass(frozen=True, slots=True)
class KnownView:
    """A mask (H, W) uint8 and the true pose of what it shows, T_camera_object (4, 4).

    Axes as in `naod.pose.objects`; a cylinder's z and a board's upper side are arbitrary.
    """

    name: str
    mask: NDArray[np.uint8]
    shape: ObjectShape
    camera: PinholeCamera
    T_camera_object: NDArray[np.float64]


def coffee_can() -> list[KnownView]:
    """Frames of YCB-Video with a coffee can, as annotated there; none where they are missing."""
    folder = photographs() / "ycbv_0001"
    if not (folder / "truth.json").is_file():
        return []
    truth = json.loads((folder / "truth.json").read_text())
    low, high = (np.array(truth["model_extent_m"][CAN][end]) for end in ("min", "max"))
    size = high - low
    can = Cylinder(radius_m=float(size[:2].mean() / 2.0), height_m=float(size[2]))
    views = []
    for frame, known in sorted(truth["frames"].items()):
        label = cv2.imread(str(folder / f"{frame}-label.png"), cv2.IMREAD_UNCHANGED)
        if label is None:
            continue
        (fx, _, cx), (_, fy, cy) = known["K"][0], known["K"][1]
        camera = PinholeCamera(width=640, height=480, fx=fx, fy=fy, cx=cx, cy=cy)
        given = np.array(known["objects"][CAN]["pose_o2c"])
        place = given[:, :3] @ (low + high) / 2.0 + given[:, 3]
        # the model's z is the can's axis
        T = _pose(np.column_stack([given[:, 0], given[:, 2], -given[:, 1]]), place)
        mask = (np.asarray(label) == CAN_LABEL).astype(np.uint8)
        views.append(KnownView(f"can {frame}", mask, can, camera, T))
    return views


def chessboard() -> list[KnownView]:
    """OpenCV's samples: masks drawn around the corners it detects, poses as calibrated there."""
    folder = photographs() / "opencv_chessboard"
    if not (folder / "left_intrinsics.yml").is_file():
        return []
    file = cv2.FileStorage(str(folder / "left_intrinsics.yml"), cv2.FILE_STORAGE_READ)
    K = file.getNode("camera_matrix").mat()
    k1, k2, p1, p2, k3 = (float(k) for k in file.getNode("distortion_coefficients").mat().ravel())
    camera = PinholeCamera(
        width=640,
        height=480,
        fx=K[0, 0],
        fy=K[1, 1],
        cx=K[0, 2],
        cy=K[1, 2],
        distortion=(k1, k2, p1, p2, k3),
    )
    board = Rectangle(width_m=(CORNERS[0] - 1) * SQUARE_M, height_m=(CORNERS[1] - 1) * SQUARE_M)
    views = []
    extrinsics = np.asarray(file.getNode("extrinsic_parameters").mat(), dtype=np.float64)
    for path, row in zip(sorted(folder.glob("left*.jpg")), extrinsics, strict=True):
        grey = np.asarray(cv2.imread(str(path), cv2.IMREAD_GRAYSCALE), dtype=np.uint8)
        found, corners = cv2.findChessboardCorners(grey, CORNERS)
        if found:
            grid = np.asarray(corners, dtype=np.float64).reshape(CORNERS[1], CORNERS[0], 2)
            mask = _inside_rim(grid)
            views.append(KnownView(path.stem, mask, board, camera, _board_pose(row, board)))
    return views


def _inside_rim(grid: NDArray[np.float64]) -> NDArray[np.uint8]:
    """A mask of what a grid (rows, columns, 2) of corners goes around."""
    rim = np.concatenate([grid[0, :-1], grid[:-1, -1], grid[-1, :0:-1], grid[:0:-1, 0]])
    mask = np.zeros((480, 640), np.uint8)
    cv2.fillPoly(mask, [np.rint(rim * 256).astype(np.int32)], 1, shift=8)
    return mask


def _board_pose(row: NDArray[np.float64], board: Rectangle) -> NDArray[np.float64]:
    """From OpenCV's: there y is down and z into the board, and the origin is a corner."""
    R, t = np.asarray(cv2.Rodrigues(row[:3])[0]), row[3:]
    middle = R @ np.array([board.width_m / 2.0, board.height_m / 2.0, 0.0]) + t
    return _pose(np.column_stack([R[:, 0], -R[:, 1], -R[:, 2]]), middle)


def _pose(R: NDArray[np.float64], t: NDArray[np.float64]) -> NDArray[np.float64]:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, t
    return T
