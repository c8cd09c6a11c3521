"""`naod segment --unsupervised N`: what a picture falls into when no colour was learnt."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

from naod.cli.pictures import Picture
from naod.config import SegmentationConfig
from naod.perception.reduction import Reduction
from naod.perception.unsupervised import classes_of


def segment_classes(picture: Picture, count: int) -> tuple[dict[str, object], NDArray[np.uint8]]:
    """A line as `naod segment` prints, and the classes as grey levels, the largest black.

    `found` says that there is more than one class; `pixels` are those outside the largest.
    """
    start = time.perf_counter()
    width, height = picture.padded_size
    reduction = Reduction((width, height), SegmentationConfig().width)
    found = classes_of(reduction(picture.yuyv), count)
    elapsed = time.perf_counter() - start
    block = reduction.block
    labels = np.repeat(np.repeat(found.labels, block, axis=0), block, axis=1)
    labels = labels[:height, : picture.width]
    shares = np.bincount(found.labels.ravel()) / found.labels.size
    line: dict[str, object] = {
        "input": picture.source,
        "found": len(found.models) > 1,
        "pixels": int(np.count_nonzero(labels)),
        "energy": found.energy,
        "iterations": len(found.betas),
        "ms": round(elapsed * 1e3, 3),
        "classes": [
            {"mean": model.mean, "share": round(float(share), 4)}
            for model, share in zip(found.models, shares, strict=True)
        ],
    }
    levels = np.linspace(0, 255, max(len(found.models), 2)).astype(np.uint8)
    return line, levels[labels]
