"""Looking around for an object that is not in view: places of the head, one after the other."""

from __future__ import annotations

import math

from hal.nao.head_limits import clip_head
from hal.types import HeadAngles

_PITCH_ROWS_DEG = (5.0, 22.0, -12.0)
_YAW_STEPS_DEG = (0.0, 35.0, -35.0, 70.0, -70.0, 105.0, -105.0)
DWELL_S = 0.7
"""Time at each place: the way there, and a sharp picture."""

FIRST_S = 3.0 * DWELL_S
"""The same for where it was last seen, which may be at the other end of the neck's range."""

PLACES: tuple[HeadAngles, ...] = tuple(
    clip_head(HeadAngles(math.radians(yaw), math.radians(pitch)))
    for pitch in _PITCH_ROWS_DEG
    for yaw in sorted(_YAW_STEPS_DEG, key=abs)
)


def search_place(first: HeadAngles | None, searching_s: float) -> HeadAngles:
    """Where to look after searching for so long: first where it was last seen, then around."""
    around_s = max(searching_s, 0.0)
    if first is not None:
        if around_s < FIRST_S:
            return first
        around_s -= FIRST_S
    return PLACES[int(around_s / DWELL_S) % len(PLACES)]
