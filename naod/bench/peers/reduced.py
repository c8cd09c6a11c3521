"""A picture as small as ours works on, for the peers that work on whole pictures of colours."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from naod.perception.colour_model import Region
from naod.perception.reduction import Reduction

WIDTH = 160


class Reduced:
    """Pictures of one size made small; regions with them."""

    def __init__(self, size: tuple[int, int]) -> None:
        self._reduction = Reduction(size, WIDTH)
        self.block = self._reduction.block
        self.size = (self._reduction.width, self._reduction.height)

    def __call__(self, yuyv: NDArray[np.uint8]) -> NDArray[np.float32]:
        """(H, W, 2) uint8 to (h, w, 3) float32 Y U V, a buffer that the next call overwrites."""
        return self._reduction(yuyv)

    def region(self, region: Region) -> Region:
        """The region in the small picture, one pixel at least."""
        block = self.block
        return Region(
            region.x // block,
            region.y // block,
            max(region.width // block, 1),
            max(region.height // block, 1),
        )
