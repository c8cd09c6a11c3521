"""The two head cameras of V5 (MT9M114) and V6 (OV5640). Source: `nao_cameras.yaml`."""

from __future__ import annotations

import math
from dataclasses import dataclass

from hal.nao.joints import Vector3
from hal.types import CameraName, NaoVersion


@dataclass(frozen=True, slots=True)
class CameraMount:
    """Where a camera sits in the Head link (x forward, y left, z up)."""

    origin_m: Vector3
    pitch_down_rad: float


@dataclass(frozen=True, slots=True)
class PinholeFigures:
    """Nominal intrinsics in pixels."""

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float


MOUNTS: dict[CameraName, CameraMount] = {
    "top": CameraMount((0.05871, 0.0, 0.06364), 0.0209435),
    "bottom": CameraMount((0.05071, 0.0, 0.01774), 0.692896),
}

FIELD_OF_VIEW_DEG: dict[NaoVersion, tuple[float, float]] = {"v5": (60.9, 47.6), "v6": (56.3, 43.7)}
"""Horizontal and vertical."""

SIZES: tuple[tuple[int, int], ...] = ((160, 120), (320, 240), (640, 480), (1280, 960))

# rolling-shutter read-out of a frame; V6 as calibrated by B-Human 2024 (upper, lower)
READOUT_S: dict[CameraName, float] = {"top": 0.037, "bottom": 0.045}

STAMP_DELAY_S: dict[CameraName, float] = {"top": -0.039, "bottom": -0.036}
"""From the driver's time stamp to the first row, V6, by the same calibration."""


def nominal_pinhole(version: NaoVersion, width: int, height: int) -> PinholeFigures:
    """Focal lengths from the field of view, centre in the middle of the picture.

    Pixel centres are at whole numbers: the middle of 640 columns is 319.5.
    """
    h_deg, v_deg = FIELD_OF_VIEW_DEG[version]
    fx = 0.5 * width / math.tan(math.radians(h_deg) / 2.0)
    fy = 0.5 * height / math.tan(math.radians(v_deg) / 2.0)
    return PinholeFigures(width, height, fx, fy, 0.5 * (width - 1), 0.5 * (height - 1))
