"""Where the head is to point so that the rectangle is seen all over the picture."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hal.nao.head_limits import clip_head
from hal.types import HeadAngles
from naod.calibration.rig import HEADS, Estimate, Rig
from naod.calibration.view import corners_in_object
from naod.pose.objects import Rectangle

COLUMNS, ROWS = 4, 3
MARGIN_PX = 16.0
"""Of 640 columns: between the rectangle and the border."""

BORDER_PX = 12.0
"""Of 640 columns: what every corner keeps from the border."""

APART_RAD = math.radians(1.5)
ROUNDS = 8


def grid(
    corners_px: NDArray[np.float64],
    size: tuple[int, int],
    columns: int,
    rows: int,
    share: float = 1.0,
) -> NDArray[np.float64]:
    """Places of the rectangle's centre (columns * rows, 2), back and forth, all of it in view.

    `share` of the room there is, about the middle.
    """
    width, height = size
    half = 0.5 * np.ptp(corners_px, axis=0) + MARGIN_PX * width / 640.0
    low, high = half, np.array([width, height]) - 1.0 - half
    middle = 0.5 * (low + high)
    reach = share * np.maximum(high - middle, 0.0)
    low, high = middle - reach, middle + reach
    xs = np.linspace(low[0], high[0], columns)
    ys = np.linspace(low[1], high[1], rows)
    places = [[x, y] for k, y in enumerate(ys) for x in (xs if k % 2 == 0 else xs[::-1])]
    return np.array(places)


def head_for(rig: Rig, at: Estimate, place_px: NDArray[np.float64]) -> HeadAngles:
    """Head angles, within limits, that put the rectangle's centre at a place (2,)."""
    head = HeadAngles(0.0, 0.0)
    centre = np.zeros((1, 3))
    for _ in range(ROUNDS):
        pixels, J = rig.pixels(at, head, 0, centre)
        step = np.linalg.lstsq(J[0, :, HEADS : HEADS + 2], place_px - pixels[0], rcond=None)[0]
        step = np.clip(step, -0.3, 0.3)
        yaw, pitch = (float(v) for v in step)
        head = clip_head(HeadAngles(head.yaw_rad + yaw, head.pitch_rad + pitch))
    return head


def head_poses(
    rig: Rig, at: Estimate, shape: Rectangle, places_px: NDArray[np.float64], size: tuple[int, int]
) -> list[HeadAngles]:
    """The head poses for places (n, 2) of the rectangle's centre.

    A place from where the rectangle would not be wholly in view is moved to the middle, step by
    step; poses that come out alike are left out.
    """
    corners, middle = corners_in_object(shape), 0.5 * (np.array(size) - 1.0)
    border = BORDER_PX * size[0] / 640.0
    poses: list[HeadAngles] = []
    for place in places_px:
        for share in (1.0, 0.85, 0.7, 0.55, 0.4, 0.2):
            head = head_for(rig, at, middle + share * (place - middle))
            seen = rig.pixels(at, head, 0, corners)[0]
            if (seen > border).all() and (seen < np.array(size) - 1.0 - border).all():
                break
        if all(apart_rad(head, other) > APART_RAD for other in poses):
            poses.append(head)
    return poses


def rows_of(count: int) -> tuple[int, int]:
    """Columns and rows of a grid with at least `count` places, in the shape of the picture."""
    columns = max(2, math.ceil(math.sqrt(count * COLUMNS / ROWS)))
    return columns, max(2, math.ceil(count / columns))


def apart_rad(a: HeadAngles, b: HeadAngles) -> float:
    """How far two head poses are apart."""
    return math.hypot(a.yaw_rad - b.yaw_rad, a.pitch_rad - b.pitch_rad)
