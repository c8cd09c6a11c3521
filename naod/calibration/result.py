"""What a calibration says, checked before anybody believes it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from naod.calibration.fit import Fitted, sigma_deg
from naod.calibration.lens import CX, CY, FX, FY, K1
from naod.calibration.rig import LENS, Rig
from naod.errors import NaodError
from naod.geometry.camera import PinholeCamera
from naod.geometry.transforms import Matrix

VIEWS_MIN = 6
SIGMA_MAX_DEG = 0.2
MISFIT_MAX = 4.0


class CalibrationError(NaodError):
    """The views do not tell how the camera sits; the text says what to do."""


@dataclass(frozen=True, slots=True)
class Calibration:
    """`correction_deg`, `sigma_deg`: roll, pitch, yaw. `lens_sigma`: fx, fy, cx, cy in px, and k1.

    `rms_px`, `misfit`: as in `Fitted`. `head_rms_deg`: how far the head was off its encoders.
    `T_base_object`: where the rectangle was.
    """

    correction_deg: tuple[float, float, float]
    sigma_deg: tuple[float, float, float]
    camera: PinholeCamera
    lens_sigma: tuple[float, float, float, float, float]
    lens_fitted: bool
    views: int
    views_left_out: int
    rms_px: float
    misfit: float
    head_rms_deg: float
    T_base_object: tuple[tuple[float, ...], ...]


def calibration(
    fitted: Fitted,
    rig: Rig,
    size: tuple[int, int],
    views: int,
    left_out: int,
    T_base_object: Matrix,
) -> Calibration:
    """Raises CalibrationError when it is not good enough to be used."""
    spread = sigma_deg(fitted)
    if fitted.misfit > MISFIT_MAX:
        raise CalibrationError(
            f"the views do not fit a rectangle of this size ({fitted.rms_px:.2f} px are left over):"
            " measure its width and height, and see that it is flat and fixed"
        )
    if spread.max() > SIGMA_MAX_DEG:
        name = ("roll", "pitch", "yaw")[int(np.argmax(spread))]
        raise CalibrationError(
            f"the views are too few or too alike: {name} is uncertain by {spread.max():.2f} "
            "degrees; put the rectangle nearer, and give more --views"
        )
    at = fitted.estimate
    correction = np.degrees(np.array([math.remainder(a, 2.0 * math.pi) for a in at.correction_rad]))
    lens_sigma = np.sqrt(np.diag(fitted.covariance)[LENS])
    return Calibration(
        correction_deg=_three(correction),
        sigma_deg=_three(spread),
        camera=_camera(at.lens, rig, size),
        lens_sigma=tuple(float(v) for v in lens_sigma),  # type: ignore[arg-type]
        lens_fitted=bool(lens_sigma.any()),
        views=views,
        views_left_out=left_out,
        rms_px=fitted.rms_px,
        misfit=fitted.misfit,
        head_rms_deg=math.degrees(float(np.sqrt(np.mean(at.heads_rad**2)))),
        T_base_object=tuple(tuple(float(v) for v in row) for row in T_base_object),
    )


def camera_lines(found: Calibration) -> dict[str, str]:
    """The keys of [camera] and their values as TOML."""
    camera, lines = found.camera, {}
    if found.lens_fitted:
        for name in ("fx", "fy", "cx", "cy"):
            lines[name] = f"{getattr(camera, name):.2f}"
        if camera.distortion is not None:
            values = ", ".join(f"{value:.5f}" for value in camera.distortion)
            lines["distortion"] = f"[{values}]"
    angles = ", ".join(f"{value:.3f}" for value in found.correction_deg)
    lines["correction_deg"] = f"[{angles}]"
    return lines


def _camera(lens: NDArray[np.float64], rig: Rig, size: tuple[int, int]) -> PinholeCamera:
    k2, p1, p2, k3 = (float(v) for v in rig.others)
    distortion = (float(lens[K1]), k2, p1, p2, k3)
    return PinholeCamera(
        width=size[0],
        height=size[1],
        fx=float(lens[FX]),
        fy=float(lens[FY]),
        cx=float(lens[CX]),
        cy=float(lens[CY]),
        distortion=distortion if any(distortion) else None,
    )


def _three(values: NDArray[np.float64]) -> tuple[float, float, float]:
    a, b, c = (float(v) for v in values)
    return a, b, c
