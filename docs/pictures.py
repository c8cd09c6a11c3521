"""Makes the README's pictures of real input; run from the repository's root.

    .venv/bin/python docs/pictures.py ../shared/data

Each shows what `naod segment` or `naod locate` found in a picture that nobody here took.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from hal.yuyv import yuyv_from_rgb
from naod.config import SegmentationConfig
from naod.geometry.camera import PinholeCamera
from naod.perception.blob import find_blob
from naod.perception.colour_model import Region, learn
from naod.perception.segmenter import Segmenter
from naod.pose.locate import locate_mask
from naod.pose.objects import Cylinder, ObjectShape, Rectangle

HERE = Path(__file__).parent
CHAIR = Region(60, 320, 160, 360)
CHAIR_FRAMES = (138, 148, 158, 167)
AXES = ((0, 0, 255), (0, 220, 0), (255, 80, 0))


def main() -> None:
    """Write docs/chair.jpg, docs/can.jpg and docs/board.jpg."""
    data = Path(sys.argv[1])
    _write("chair.jpg", chair(data / "nao_walk"))
    _write("can.jpg", can(data / "ycbv_0001"))
    _write("board.jpg", board(data / "opencv_chessboard"))


def chair(folder: Path) -> NDArray[np.uint8]:
    """Frames of the walk side by side, the chair's mask outlined."""
    pictures = [_read(folder / f"20130621-01-{n}.jpg") for n in CHAIR_FRAMES]
    yuyv = [yuyv_from_rgb(picture[..., ::-1]) for picture in pictures]
    model = learn(yuyv[:1], CHAIR)
    height, width = pictures[0].shape[:2]
    segmenter = Segmenter(model, SegmentationConfig(), (width, height))
    tiles = []
    for picture, frame in zip(pictures, yuyv, strict=True):
        segmentation = segmenter.segment(frame)
        mask = cv2.resize(segmentation.mask, (width, height), interpolation=cv2.INTER_NEAREST)
        outlines, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        cv2.drawContours(picture, outlines, -1, (255, 0, 255), 8)
        blob = find_blob(segmentation)
        if blob is not None:
            box = np.rint(blob.corners_px).astype(np.int32).reshape(-1, 1, 2)
            cv2.polylines(picture, [box], True, (255, 255, 255), 3, cv2.LINE_AA)
        tiles.append(cv2.resize(picture, (320, 240), interpolation=cv2.INTER_AREA))
    return np.hstack(tiles)


def can(folder: Path) -> NDArray[np.uint8]:
    """The coffee can's pose from its mask."""
    truth = json.loads((folder / "truth.json").read_text())
    picture = _read(folder / "0001" / "000005-color.png")
    label = cv2.imread(str(folder / "0001" / "000005-label.png"), cv2.IMREAD_UNCHANGED)
    shape, camera = ycbv_can(truth)
    return _located(picture, (label == 1).astype(np.uint8), shape, camera)


def ycbv_can(truth: dict[str, Any]) -> tuple[Cylinder, PinholeCamera]:
    """Size of the can and the camera, from the data set's truth."""
    extent = truth["model_extent_m"]["002_master_chef_can"]
    x, y, z = np.subtract(extent["max"], extent["min"])
    K = truth["frames"]["0001/000005"]["K"]
    shape = Cylinder(radius_m=float(x + y) / 4.0, height_m=float(z))
    return shape, _camera(np.array(K), None)


def board(folder: Path) -> NDArray[np.uint8]:
    """The chessboard's inner rectangle, 0.200 x 0.125 m, from a mask of it."""
    picture = _read(folder / "left03.jpg")
    stored = cv2.FileStorage(str(folder / "left_intrinsics.yml"), cv2.FILE_STORAGE_READ)
    distortion = stored.getNode("distortion_coefficients").mat().ravel()
    camera = _camera(stored.getNode("camera_matrix").mat(), distortion)
    grey = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
    found, corners = cv2.findChessboardCorners(grey, (9, 6))
    if not found:
        raise SystemExit("no chessboard")
    grid = corners.reshape(6, 9, 2)
    ring = np.vstack([grid[0], grid[:, -1], grid[-1, ::-1], grid[::-1, 0]])
    mask = np.zeros(grey.shape, np.uint8)
    cv2.fillPoly(mask, [np.rint(ring).astype(np.int32).reshape(-1, 1, 2)], 255)
    return _located(picture, mask, Rectangle(width_m=0.2, height_m=0.125), camera)


def _camera(K: NDArray[np.float64], distortion: NDArray[np.float64] | None) -> PinholeCamera:
    coefficients = None if distortion is None else tuple(float(v) for v in distortion[:5])
    return PinholeCamera(
        width=640, height=480, fx=K[0, 0], fy=K[1, 1], cx=K[0, 2], cy=K[1, 2],
        distortion=coefficients,
    )  # fmt: skip


def _located(
    picture: NDArray[np.uint8], mask: NDArray[np.uint8], shape: ObjectShape, camera: PinholeCamera
) -> NDArray[np.uint8]:
    pose = locate_mask(mask, shape, camera)
    if pose is None:
        raise SystemExit("not located")
    corners = np.rint(pose.corners_px).astype(np.int32).reshape(-1, 1, 2)
    cv2.polylines(picture, [corners], True, (0, 255, 255), 2, cv2.LINE_AA)
    T = pose.T_camera_object
    points = np.vstack([T[:3, 3], T[:3, 3] + 0.06 * T[:3, :3].T])
    origin, *tips = (tuple(int(v) for v in np.rint(p)) for p in camera.project(points))
    for tip, colour in zip(tips, AXES, strict=True):
        cv2.arrowedLine(picture, origin, tip, colour, 3, cv2.LINE_AA)
    return picture


def _read(path: Path) -> NDArray[np.uint8]:
    picture = cv2.imread(str(path))
    if picture is None:
        raise SystemExit(f"{path}: cannot be read")
    return np.asarray(picture, dtype=np.uint8)


def _write(name: str, picture: NDArray[np.uint8]) -> None:
    cv2.imwrite(str(HERE / name), picture, [cv2.IMWRITE_JPEG_QUALITY, 85])


if __name__ == "__main__":
    main()
