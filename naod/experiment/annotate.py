"""A camera picture with what was made of it drawn on: mask, edges, axes, distance."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from hal.types import Frame
from hal.yuyv import rgb_from_yuyv
from naod.geometry.camera import PinholeCamera
from naod.loop.equipment import Sighting

_GREEN, _YELLOW, _WHITE = (60, 220, 60), (255, 220, 40), (255, 255, 255)
_AXES = ((255, 60, 60), (60, 255, 60), (80, 120, 255))


def annotated(
    frame: Frame, sighting: Sighting | None, camera: PinholeCamera, axis_m: float = 0.06
) -> NDArray[np.uint8]:
    """The frame as (H, W, 3) RGB uint8, drawn on."""
    picture = np.ascontiguousarray(rgb_from_yuyv(frame.yuyv))
    if sighting is None:
        _write(picture, "not seen", 0)
        return picture
    _draw_mask(picture, sighting.segmentation.mask)
    if sighting.pose is not None:
        corners = np.rint(sighting.pose.corners_px).astype(np.int32).reshape(-1, 1, 2)
        cv2.polylines(picture, [corners], True, _YELLOW, 1, cv2.LINE_AA)
        _draw_axes(picture, sighting.pose.T_camera_object, camera, axis_m)
    if sighting.look is not None:
        ego = sighting.look.ego
        _write(picture, f"rho {ego.rho_m:.3f} m  theta {np.degrees(ego.theta_rad):+.1f} deg", 0)
        _write(picture, f"z {ego.z_m:.3f} m  phi {np.degrees(ego.phi_rad):+.1f} deg", 1)
    return picture


def _draw_mask(picture: NDArray[np.uint8], mask: NDArray[np.uint8]) -> None:
    height, width = picture.shape[:2]
    large = cv2.resize(mask, (width, height), interpolation=cv2.INTER_NEAREST)
    inside = large > 0
    picture[inside] = (0.65 * picture[inside] + 0.35 * np.array(_GREEN)).astype(np.uint8)
    outlines, _ = cv2.findContours(large, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    cv2.drawContours(picture, outlines, -1, _GREEN, 1)


def _draw_axes(
    picture: NDArray[np.uint8], T: NDArray[np.float64], camera: PinholeCamera, length_m: float
) -> None:
    points = np.vstack([T[:3, 3], T[:3, 3] + length_m * T[:3, :3].T])
    if points[:, 2].min() <= 0.0:
        return
    origin, *tips = (tuple(int(v) for v in np.rint(p)) for p in camera.project(points))
    for tip, colour in zip(tips, _AXES, strict=True):
        cv2.arrowedLine(picture, origin, tip, colour, 2, cv2.LINE_AA, tipLength=0.2)


def _write(picture: NDArray[np.uint8], text: str, row: int) -> None:
    place = (8, 20 + 20 * row)
    cv2.putText(picture, text, place, cv2.FONT_HERSHEY_SIMPLEX, 0.5, (0, 0, 0), 3, cv2.LINE_AA)
    cv2.putText(picture, text, place, cv2.FONT_HERSHEY_SIMPLEX, 0.5, _WHITE, 1, cv2.LINE_AA)
