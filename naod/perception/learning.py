"""The colour model of the kind asked for, from frames in which a person marked a region."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from naod.perception.colour_model import ColourModel, Region, learn
from naod.perception.colour_table_learning import learn_table
from naod.perception.mixture import learn_mixture

ModelKind = Literal["gaussian", "mixture", "table"]
KINDS: tuple[ModelKind, ...] = ("gaussian", "mixture", "table")
DEFAULT_KIND: ModelKind = "table"
"""The one that survives blur, many colours and another room; the paper's is the Gaussian."""


def learn_model(
    frames: Sequence[NDArray[np.uint8]], region: Region, kind: ModelKind = DEFAULT_KIND
) -> ColourModel:
    """From YUYV frames (H, W, 2) uint8. Raises InputError as `colour_model.learn` does."""
    if kind == "table":
        return learn_table(frames, region)
    return learn_mixture(frames, region) if kind == "mixture" else learn(frames, region)
