"""How long a frame is exposed, how bright it is, and whether the camera moved meanwhile."""

from __future__ import annotations

import math

from sim_backend.poses import Matrix

EXPOSURE_S = 0.010
"""In the scenario's normal light; a dimmer room takes longer, up to a 30 Hz frame's time."""
EXPOSURE_MAX_S = 0.033
STILL_PX = 0.15
NEAR_M = 0.35
"""Blur by translation is judged for things this near."""


def exposure_for(light: float, fps: int) -> float:
    """Exposure in s, fixed for a run, as with automatic exposure locked."""
    return min(max(EXPOSURE_S / light, EXPOSURE_S), EXPOSURE_MAX_S, 0.9 / fps)


def brightness_at(light: float, drift_per_min: float, time_s: float) -> float:
    """Light in the room after a time, relative to normal; never quite dark."""
    return max(light * (1.0 + drift_per_min * time_s / 60.0), 0.02)


def motion_px(T_world_first: Matrix, T_world_last: Matrix, focal_px: float) -> float:
    """Bound on how far a picture moved between two camera poses."""
    turn = T_world_first[:3, :3].T @ T_world_last[:3, :3]
    cosine = min(max((float(turn.trace()) - 1.0) / 2.0, -1.0), 1.0)
    shift = float(((T_world_last[:3, 3] - T_world_first[:3, 3]) ** 2).sum()) ** 0.5
    return focal_px * (1.5 * math.acos(cosine) + shift / NEAR_M)
