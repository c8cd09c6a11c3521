"""Ours with the table of colours that is learnt with synthetic blur."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from naod.bench.peers.ours import Ours
from naod.config import SegmentationConfig
from naod.perception.colour_model import Region
from naod.perception.learning import learn_model


class TableOurs(Ours):
    """The exact minimum as before; only the model differs."""

    def learn(self, yuyv: NDArray[np.uint8], region: Region) -> None:
        """A table from the region and what is around it."""
        self.use(learn_model([yuyv], region, "table"))


def make(size: tuple[int, int]) -> TableOurs:
    """With the daemon's own settings."""
    return TableOurs(size, SegmentationConfig())
