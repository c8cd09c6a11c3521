"""The interface of everything that is compared."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import Protocol, cast

import numpy as np
from numpy.typing import NDArray

from naod.perception.colour_model import Region

PEERS: dict[str, str] = {
    "exact minimum": "ours",
    "exact minimum, blur table": "blur_table",
    "ICM": "icm",
    "HSV threshold": "hsv",
    "CAMShift": "camshift",
    "GrabCut at 160x120": "grabcut",
    "k-means": "kmeans",
    "mixture by EM": "mixture",
    "Lucas-Kanade": "lucas_kanade",
    "Wiener, then exact": "wiener",
    "Richardson-Lucy, then exact": "richardson_lucy",
    "exact by PyMaxflow": "pymaxflow",
}
"""By name: the module in this package. The first is ours."""


Motion = tuple[float, float]
STILL: Motion = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Seen:
    """What a peer made of a picture.

    mask: (h, w) uint8, non-zero = object. grain_px: full pixels per mask pixel. corners_px: (4, 2)
    of the object's box in full pixels, None when it is not seen.
    """

    mask: NDArray[np.uint8]
    grain_px: float
    corners_px: NDArray[np.float64] | None


class Peer(Protocol):
    """Learns once what a person marked, then sees picture after picture of the same size."""

    def learn(self, yuyv: NDArray[np.uint8], region: Region) -> None:
        """Begin anew from a picture (H, W, 2) and the object's middle in it."""
        ...

    def segment(self, yuyv: NDArray[np.uint8], motion_px: Motion = STILL) -> Seen:
        """From the camera's picture (H, W, 2) uint8 to mask and box.

        motion_px: how far the object went through the picture during the exposure, right and
        down. A robot knows it from its gyro; who has no use for it leaves it.
        """
        ...


def make_peer(name: str, size: tuple[int, int]) -> Peer:
    """The peer of that name for pictures of (width, height).

    Raises ImportError where the library that it stands for is not installed.
    """
    module = importlib.import_module(f"naod.bench.peers.{PEERS[name]}")
    return cast(Peer, module.make(size))
