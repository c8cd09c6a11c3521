"""Blur undone first, then ours: what the paper weighs against a segmentation that bears blur.

Both filters are told the true motion, better than a robot knows it. They are a few lines of
convolution each and are written out here: scikit-image's need a stack of further packages, work
in float64 and take no colours.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from naod.bench.motion import LEAST_PX, motion_kernel
from naod.bench.peers.ours import Ours
from naod.bench.peers.peer import STILL, Motion, Seen
from naod.bench.peers.reduced import Reduced
from naod.perception.colour_model import Region

Filter = Callable[[NDArray[np.float32], NDArray[np.float32]], NDArray[np.float32]]
"""From a picture (h, w, 3) and a kernel, odd square of sum 1, to the picture without it."""


class Restored:
    """A filter on the small picture, then the exact minimum on what comes out."""

    def __init__(self, size: tuple[int, int], undo: Filter) -> None:
        self._reduced, self._undo = Reduced(size), undo
        width, height = self._reduced.size
        self._ours = Ours((width + width % 2, height), kind="gaussian")

    def learn(self, yuyv: NDArray[np.uint8], region: Region) -> None:
        """As ours does, from the whole picture."""
        self._ours.learn(yuyv, region)

    def segment(self, yuyv: NDArray[np.uint8], motion_px: Motion = STILL) -> Seen:
        """Undo, label, box."""
        picture, grain = self._reduced(yuyv), float(self._reduced.block)
        dx, dy = motion_px[0] / grain, motion_px[1] / grain
        if math.hypot(dx, dy) >= LEAST_PX:
            picture = self._undo(picture, motion_kernel(dx, dy))
        seen = self._ours.segment(_encoded(picture), (0.0, 0.0))
        corners = seen.corners_px
        if corners is not None:
            corners = (corners + 0.5) * grain - 0.5
        return Seen(seen.mask, grain * seen.grain_px, corners)


def _encoded(picture: NDArray[np.float32]) -> NDArray[np.uint8]:
    """(h, w, 3) Y U V to YUYV (h, w, 2), an odd last column twice."""
    if picture.shape[1] % 2:
        picture = np.concatenate([picture, picture[:, -1:]], axis=1)
    height, width = picture.shape[:2]
    out = np.empty((height, width, 2), dtype=np.uint8)
    levels = np.clip(picture, 0.0, 255.0)
    out[..., 0] = levels[..., 0] + 0.5
    chroma = 0.5 * (levels[:, 0::2, 1:] + levels[:, 1::2, 1:])
    out[..., 1] = (chroma + 0.5).reshape(height, width)
    return out
