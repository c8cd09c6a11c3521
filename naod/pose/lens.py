"""The lens in kernels: between pixels and the plane z = 1, OpenCV's distortion included."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.geometry.camera import PinholeCamera

FX, FY, CX, CY, K1, K2, P1, P2, K3, WIDTH, HEIGHT = range(11)
ROUNDS = 40
"""Of undoing a distortion; a moderate one takes five."""


@lru_cache(maxsize=16)
def lens_of(camera: PinholeCamera) -> NDArray[np.float64]:
    """(11,) fx, fy, cx, cy, k1, k2, p1, p2, k3, width, height, as the kernels take them.

    One array for all who ask: not to be written to.
    """
    c = camera
    bent = c.distortion or (0.0, 0.0, 0.0, 0.0, 0.0)
    return np.array((c.fx, c.fy, c.cx, c.cy, *bent, c.width, c.height), dtype=np.float64)


@njit(cache=True, nogil=True)
def _bend(lens: NDArray[np.float64], u: float, v: float) -> tuple[float, float, float]:
    """Radial factor, and the tangential shift, at an undistorted point."""
    r2 = u * u + v * v
    radial = 1.0 + r2 * (lens[K1] + r2 * (lens[K2] + r2 * lens[K3]))
    du = 2.0 * lens[P1] * u * v + lens[P2] * (r2 + 2.0 * u * u)
    return radial, du, lens[P1] * (r2 + 2.0 * v * v) + 2.0 * lens[P2] * u * v


@njit(cache=True, nogil=True)
def to_pixel(lens: NDArray[np.float64], u: float, v: float) -> tuple[float, float]:
    """Where a point of the plane z = 1 is seen."""
    radial, du, dv = _bend(lens, u, v)
    return lens[FX] * (u * radial + du) + lens[CX], lens[FY] * (v * radial + dv) + lens[CY]


@njit(cache=True, nogil=True)
def from_pixel(lens: NDArray[np.float64], x: float, y: float) -> tuple[float, float]:
    """The point of the plane z = 1 that is seen at a pixel."""
    u0, v0 = (x - lens[CX]) / lens[FX], (y - lens[CY]) / lens[FY]
    u, v = u0, v0
    for _ in range(ROUNDS):
        radial, du, dv = _bend(lens, u, v)
        if not radial > 0.05:
            break
        last_u, last_v = u, v
        u, v = (u0 - du) / radial, (v0 - dv) / radial
        if math.hypot(u - last_u, v - last_v) < 1e-11:
            break
    return u, v


@njit(cache=True, nogil=True)
def from_pixels(
    lens: NDArray[np.float64], pixels: NDArray[np.float64], points: NDArray[np.float64]
) -> None:
    """All of (n, 2)."""
    for i in range(pixels.shape[0]):
        points[i, 0], points[i, 1] = from_pixel(lens, pixels[i, 0], pixels[i, 1])


@njit(cache=True, nogil=True)
def focal(lens: NDArray[np.float64]) -> float:
    """One focal length for both axes."""
    return math.sqrt(lens[FX] * lens[FY])
