"""The two joints of the neck: range by yaw, limited speed, a servo's lag."""

from __future__ import annotations

import math

from hal.errors import MotionRefusedError
from hal.nao.head_limits import HEAD_SPEED_MAX_RAD_S, clip_head
from hal.types import HeadAngles

LAG_S = 0.020
"""Time constant of the servo (measured for such motors in physics studies of this robot)."""

_AHEAD = HeadAngles(0.0, 0.0)


class HeadServo:
    """Holds no clock: `run` moves it on by a time in seconds."""

    def __init__(self) -> None:
        self.target = _AHEAD
        self.speed_rad_s = 1.0
        self._set_point = _AHEAD
        self.angles = _AHEAD

    def look(self, target: HeadAngles, speed_rad_s: float) -> HeadAngles:
        """Turn towards a target; returns it clipped. Raises MotionRefusedError."""
        if not (math.isfinite(speed_rad_s) and speed_rad_s > 0.0):
            raise MotionRefusedError(f"head speed is not a positive number: {speed_rad_s}")
        self.target = clip_head(target)
        self.speed_rad_s = speed_rad_s
        return self.target

    def straighten(self) -> None:
        """Ahead and at rest, at once."""
        self.target = self._set_point = self.angles = _AHEAD

    def run(self, dt: float) -> None:
        """Move on by `dt` seconds."""
        yaw_top, pitch_top = (min(self.speed_rad_s, top) * dt for top in HEAD_SPEED_MAX_RAD_S)
        self._set_point = clip_head(
            HeadAngles(
                _towards(self._set_point.yaw_rad, self.target.yaw_rad, yaw_top),
                _towards(self._set_point.pitch_rad, self.target.pitch_rad, pitch_top),
            )
        )
        share = 1.0 - math.exp(-dt / LAG_S)
        self.angles = HeadAngles(
            self.angles.yaw_rad + share * (self._set_point.yaw_rad - self.angles.yaw_rad),
            self.angles.pitch_rad + share * (self._set_point.pitch_rad - self.angles.pitch_rad),
        )


def _towards(now: float, target: float, most: float) -> float:
    return now + min(max(target - now, -most), most)
