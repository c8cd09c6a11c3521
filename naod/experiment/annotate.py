"""A camera picture with what was made of it drawn on: mask, edges, axes, distance."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from hal.types import Frame
from hal.yuyv import rgb_from_yuyv
from naod.geometry.camera import PinholeCamera
from naod.loop.equipment import Sighting
from naod.pose.objects import Cylinder, ObjectShape

_GREEN, _YELLOW, _WHITE, _INK = (60, 220, 60), (255, 220, 40), (255, 255, 255), (0, 0, 0)
_AXES = ((255, 60, 60), (60, 255, 60), (80, 120, 255))


def annotated(
    frame: Frame,
    sighting: Sighting | None,
    camera: PinholeCamera,
    shape: ObjectShape,
    axis_m: float = 0.06,
) -> NDArray[np.uint8]:
    """The frame as (H, W, 3) RGB uint8, drawn on."""
    picture = np.ascontiguousarray(rgb_from_yuyv(frame.yuyv))
    if sighting is None:
        return _written(picture, "not seen")
    _draw_mask(picture, sighting.segmentation.mask)
    if sighting.pose is not None:
        edge = np.rint(_outline(shape, sighting.pose.T_camera_object, camera)).astype(np.int32)
        cv2.polylines(picture, [cv2.convexHull(edge)], True, _YELLOW, 1, cv2.LINE_AA)
        _draw_axes(picture, sighting.pose.T_camera_object, camera, axis_m)
    if sighting.look is None:
        return picture
    ego = sighting.look.ego
    theta, phi = np.degrees(ego.theta_rad), np.degrees(ego.phi_rad)
    first = f"rho {ego.rho_m:.3f} m   theta {theta:+.1f}°"
    return _written(picture, f"{first}\nz {ego.z_m:.3f} m   phi {phi:+.1f}°")


def _draw_mask(picture: NDArray[np.uint8], mask: NDArray[np.uint8]) -> None:
    height, width = picture.shape[:2]
    large = cv2.resize(mask, (width, height), interpolation=cv2.INTER_NEAREST)
    inside = large > 0
    picture[inside] = (0.8 * picture[inside] + 0.2 * np.array(_GREEN)).astype(np.uint8)
    outlines, _ = cv2.findContours(large, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    cv2.drawContours(picture, outlines, -1, _GREEN, 1)


def _outline(
    shape: ObjectShape, T: NDArray[np.float64], camera: PinholeCamera
) -> NDArray[np.float64]:
    """(n, 2) pixels whose hull is the object's outline at a pose."""
    if isinstance(shape, Cylinder):
        turn = np.linspace(0.0, 2.0 * np.pi, 72)
        x, z = shape.radius_m * np.cos(turn), shape.radius_m * np.sin(turn)
        y = np.full_like(turn, 0.5 * shape.height_m)
        points = np.vstack([np.column_stack((x, s * y, z)) for s in (1.0, -1.0)])
    else:
        corners = np.array([[-1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, -1.0, 0.0]])
        points = corners * (0.5 * shape.width_m, 0.5 * shape.height_m, 0.0)
    return camera.project(points @ T[:3, :3].T + T[:3, 3])


def _draw_axes(
    picture: NDArray[np.uint8], T: NDArray[np.float64], camera: PinholeCamera, length_m: float
) -> None:
    points = np.vstack([T[:3, 3], T[:3, 3] + length_m * T[:3, :3].T])
    if points[:, 2].min() <= 0.0:
        return
    origin, *tips = (tuple(int(v) for v in np.rint(p)) for p in camera.project(points))
    for tip, colour in zip(tips, _AXES, strict=True):
        cv2.arrowedLine(picture, origin, tip, colour, 2, cv2.LINE_AA, tipLength=0.2)


def _written(picture: NDArray[np.uint8], text: str) -> NDArray[np.uint8]:
    image = Image.fromarray(picture)
    font = ImageFont.load_default(size=18)
    ImageDraw.Draw(image).text((8, 6), text, _WHITE, font, stroke_width=2, stroke_fill=_INK)
    return np.array(image)
