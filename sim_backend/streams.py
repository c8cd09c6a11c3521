"""Random numbers: one stream for each purpose, so that asking for one never changes another."""

from __future__ import annotations

from enum import IntEnum

import numpy as np


class Purpose(IntEnum):
    """What a stream is for."""

    CLUTTER = 1
    SLIP = 2
    SENSORS = 3
    DROPS = 4
    PIXELS = 5


def stream(seed: int, purpose: Purpose, count: int = 0) -> np.random.Generator:
    """The stream of a purpose; `count` numbers its moves or frames."""
    return np.random.default_rng([seed, int(purpose), count])
