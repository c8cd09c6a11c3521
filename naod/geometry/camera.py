"""Pinhole cameras with OpenCV's distortion, and CAMERA.toml."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import Annotated

import cv2
import msgspec
import numpy as np
from msgspec import Meta
from numpy.typing import NDArray

from hal.nao.cameras import nominal_pinhole
from hal.types import NaoVersion
from naod.files import read_toml

Positive = Annotated[float, Meta(gt=0.0)]


class PinholeCamera(
    msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, dict=True
):
    """Intrinsics in pixels; pixel centres are at whole numbers. `distortion`: k1 k2 p1 p2 k3."""

    width: Annotated[int, Meta(gt=0)]
    height: Annotated[int, Meta(gt=0)]
    fx: Positive
    fy: Positive
    cx: float
    cy: float
    distortion: tuple[float, float, float, float, float] | None = None

    @cached_property
    def K(self) -> NDArray[np.float64]:
        """The (3, 3) intrinsic matrix."""
        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])

    @cached_property
    def distortion_array(self) -> NDArray[np.float64]:
        """(5,) coefficients, zeros if there are none."""
        return np.array(self.distortion or (0.0,) * 5)

    def normalised(self, pixels: NDArray[np.float64]) -> NDArray[np.float64]:
        """Pixels (n, 2) to undistorted points on the plane z = 1, (n, 2)."""
        if self.distortion is None:
            return (pixels - (self.cx, self.cy)) / (self.fx, self.fy)
        points = np.ascontiguousarray(pixels, dtype=np.float64).reshape(-1, 1, 2)
        criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 40, 1e-10)
        out = cv2.undistortPoints(points, self.K, self.distortion_array, criteria=criteria)
        return np.asarray(out, dtype=np.float64).reshape(-1, 2)

    def project(self, points_in_camera: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points (n, 3) in front of the camera to pixels (n, 2), distortion included."""
        points = np.asarray(points_in_camera, dtype=np.float64).reshape(-1, 3)
        if self.distortion is None:
            return points[:, :2] / points[:, 2:] * (self.fx, self.fy) + (self.cx, self.cy)
        zero = np.zeros(3)
        out, _ = cv2.projectPoints(points, zero, zero, self.K, self.distortion_array)
        return np.asarray(out, dtype=np.float64).reshape(-1, 2)

    def resized(self, width: int, height: int) -> PinholeCamera:
        """The same camera at another resolution, pixel centres kept in place."""
        sx, sy = width / self.width, height / self.height
        return PinholeCamera(
            width=width,
            height=height,
            fx=self.fx * sx,
            fy=self.fy * sy,
            cx=(self.cx + 0.5) * sx - 0.5,
            cy=(self.cy + 0.5) * sy - 0.5,
            distortion=self.distortion,
        )


def nominal_camera(version: NaoVersion, width: int, height: int) -> PinholeCamera:
    """The published camera of a NAO (`nao_cameras.yaml`)."""
    p = nominal_pinhole(version, width, height)
    return PinholeCamera(width=p.width, height=p.height, fx=p.fx, fy=p.fy, cx=p.cx, cy=p.cy)


def load_camera(path: Path) -> PinholeCamera:
    """Read CAMERA.toml. Raises InputError that names the file and the key."""
    return read_toml(path, PinholeCamera)
