"""What the robot shows of its mode: the chest's colour, the ears while somebody is connected."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from hal.lola.actuators import DARK, Lights
from hal.lola.modes import Mode

_CHEST: dict[Mode, tuple[float, float, float]] = {
    "hold": (0.0, 0.6, 0.2),
    "stand": (0.0, 1.0, 0.0),
    "rest": (0.0, 0.0, 0.4),
    "fallen": (1.0, 0.0, 0.0),
}
_ALONE = (1.0, 0.5, 0.0)


@cache
def lights(mode: Mode, alone: bool) -> Lights:
    """Green to blue while all is well, red when it has fallen, amber without a client."""
    chest = _ALONE if alone and mode != "fallen" else _CHEST[mode]
    ears = np.full(10, 0.0 if alone else 0.5)
    return replace(DARK, chest=np.array(chest), left_ear=ears, right_ear=ears)
