"""The interface of everything that is compared."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import Protocol, cast

import numpy as np
from numpy.typing import NDArray

from naod.perception.colour_model import Region
from naod.perception.learning import DEFAULT_KIND, ModelKind
from naod.pose.objects import ObjectShape

BY_EDGES = "by edges"

OURS: dict[str, str] = {
    "naod": "",
    "naod, box by its edges": BY_EDGES,
    "mixture of Gaussians, exact": "mixture",
    "one Gaussian, exact": "gaussian",
    "one Gaussian, ICM": "gaussian icm",
}
"""By name: kind of model and optimiser where they are not the daemon's own; BY_EDGES: with the
box of the pose that the edges in the picture give."""

PEERS: dict[str, str] = {
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
"""By name: the module in this package."""

CONTESTANTS = (*OURS, *PEERS)

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


def make_peer(name: str, size: tuple[int, int], shape: ObjectShape | None = None) -> Peer:
    """The peer of that name for pictures of (width, height).

    `shape`: what ours is told of the object; nobody else has a use for it. Raises ImportError where
    the library that it stands for is not installed.
    """
    if name in OURS:
        return ours_of(OURS[name], size, shape)
    module = importlib.import_module(f"naod.bench.peers.{PEERS[name]}")
    return cast(Peer, module.make(size))


def ours_of(variant: str, size: tuple[int, int], shape: ObjectShape | None) -> Peer:
    """Ours with "kind" or "kind optimiser" of OURS."""
    from naod.bench.peers.ours import Ours

    if variant == BY_EDGES:
        return Ours(size, shape=shape, by_edges=True)
    kind, _, optimiser = variant.partition(" ")
    return Ours(size, optimiser or "exact", cast(ModelKind, kind or DEFAULT_KIND), shape)
