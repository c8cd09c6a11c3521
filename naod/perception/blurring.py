"""What a moving camera makes of an object and of what is behind it, in linear light."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from hal.yuyv import yuv_from_rgb
from naod.perception.encoding import LEVEL, LIGHT

Floats = NDArray[np.float32]

_ZERO = np.array([0.0, 128.0, 128.0], dtype=np.float32)
_RGB_FROM_YUV = np.linalg.inv(yuv_from_rgb(np.eye(3)) - _ZERO).astype(np.float32)
_PER_LEVEL = 16
_LIGHTS = np.interp(np.arange(255 * _PER_LEVEL + 1) / _PER_LEVEL, np.arange(256), LIGHT).astype(
    np.float32
)
_ENTRIES = 4096
_CURVE = np.interp(
    256.0 * np.sqrt(np.arange(_ENTRIES + 1) / _ENTRIES), np.arange(LEVEL.size), LEVEL
).astype(np.float32)


def light_from_yuv(yuv: Floats) -> Floats:
    """(..., 3) Y U V, 8-bit levels, to linear light of red, green and blue, 0 to 1."""
    rgb = (yuv - _ZERO) @ _RGB_FROM_YUV
    return _LIGHTS[np.clip(rgb * _PER_LEVEL + 0.5, 0.0, _LIGHTS.size - 1.0).astype(np.int32)]


def yuv_from_light(light: Floats) -> Floats:
    """The way back; light above 1 saturates, as in the camera."""
    places = np.clip(light * _ENTRIES, 0.0, _ENTRIES).astype(np.int32)
    return yuv_from_rgb(_CURVE[places])


@dataclass(frozen=True, slots=True)
class Layers:
    """An object cut out, and the picture as if it were not there.

    `share` (h, w) float32: how much of a pixel, and of the exposure, shows the object. `object`
    (h, w, 3): the object's part of the light; `behind` (h, w, 3): the rest of it.
    """

    share: Floats
    object: Floats
    behind: Floats


def cut_out(light: Floats, inside: NDArray[np.bool_], unsure: NDArray[np.bool_]) -> Layers:
    """Layers of a sharp picture in linear light (h, w, 3).

    Behind the object and where it is unsure what is seen, (h, w) bool both, lies the nearest of
    what is known to be background.
    """
    hidden = (inside | unsure).astype(np.uint8)
    _, labels = cv2.distanceTransformWithLabels(
        hidden, cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL
    )
    known = hidden == 0
    colours = np.zeros((int(labels.max()) + 1, 3), dtype=np.float32)
    colours[labels[known]] = light[known]
    share = inside.astype(np.float32)
    return Layers(share, light * share[..., None], colours[labels] * (1.0 - share[..., None]))


def smeared(layers: Layers, length_px: float, angle_rad: float) -> Layers:
    """The same during a straight motion across the picture."""
    kernel = line_kernel(length_px, angle_rad)
    return Layers(
        *(_filtered(part, kernel) for part in (layers.share, layers.object, layers.behind))
    )


def _filtered(part: Floats, kernel: Floats) -> Floats:
    return np.asarray(cv2.filter2D(part, -1, kernel, borderType=cv2.BORDER_REPLICATE))


def line_kernel(length_px: float, angle_rad: float) -> Floats:
    """A straight motion's kernel, odd square, float32, sum 1; 0 pixels is no motion."""
    half = math.ceil(length_px / 2.0)
    kernel = np.zeros((2 * half + 1, 2 * half + 1), dtype=np.float64)
    steps = 8 * half + 1
    for along in (np.arange(steps) + 0.5) / steps - 0.5:
        _drop(kernel, half + along * length_px * math.cos(angle_rad),
              half + along * length_px * math.sin(angle_rad))  # fmt: skip
    return (kernel / kernel.sum()).astype(np.float32)


def _drop(kernel: NDArray[np.float64], x: float, y: float) -> None:
    """Add one between pixels, shared out among the four around it."""
    j, i = int(x), int(y)
    for row, down in ((i, 1.0 - (y - i)), (i + 1, y - i)):
        for column, right in ((j, 1.0 - (x - j)), (j + 1, x - j)):
            if down * right > 0.0:
                kernel[row, column] += down * right


def motions(lengths_px: tuple[float, ...], angles: int) -> Iterator[tuple[float, float]]:
    """Each length in each of `angles` directions over half a turn; length 0 once."""
    for length in lengths_px:
        for n in range(angles if length > 0.0 else 1):
            yield length, math.pi * n / angles
