"""A velocity as displacements that end by themselves, each leading a little ahead.

NAOqi keeps a velocity for ever. Where a network lies between it and the watchdog, a cable that is
pulled out would leave the robot walking; a displacement it ends by itself.
"""

from __future__ import annotations

import math

from hal.naoqi.odometry import Pose, composed, seen_from
from hal.types import PlanarMotion

AHEAD_S = 0.8
"""The walk's preview (`walk_facts.yaml`): what is nearer than this cannot be changed any more."""
EVERY_S = 0.4


class Lead:
    """Where a velocity, begun at a pose and a time, leads."""

    def __init__(self, velocity: PlanarMotion, pose: PlanarMotion, now_s: float) -> None:
        self._velocity = velocity
        self._start, self._start_s = _tuple(pose), now_s
        self._sent_s = -EVERY_S

    def is_due(self, now_s: float) -> bool:
        """Whether another displacement should be sent."""
        return now_s - self._sent_s >= EVERY_S

    def displacement(self, pose: PlanarMotion, now_s: float) -> PlanarMotion:
        """From the pose it has now to where it should be AHEAD_S from now.

        A robot that stays behind is not chased: then it begins anew from where it is.
        """
        self._sent_s = now_s
        way = self._way(pose, now_s)
        if math.hypot(way[0], way[1]) > 2.0 * AHEAD_S * self._speed or (
            abs(way[2]) > 2.0 * AHEAD_S * abs(self._velocity.yaw) + 0.1
        ):
            self._start, self._start_s = _tuple(pose), now_s
            way = self._way(pose, now_s)
        return PlanarMotion(*way)

    @property
    def _speed(self) -> float:
        return math.hypot(self._velocity.x, self._velocity.y) + 0.02

    def _way(self, pose: PlanarMotion, now_s: float) -> Pose:
        target = composed(self._start, along(self._velocity, now_s - self._start_s + AHEAD_S))
        x, y, yaw = seen_from(_tuple(pose), target)
        return (x, y, math.remainder(yaw, 2.0 * math.pi))


def along(velocity: PlanarMotion, time_s: float) -> Pose:
    """Where a constant velocity of the base leads in a time: an arc."""
    turn = velocity.yaw * time_s
    x, y = velocity.x * time_s, velocity.y * time_s
    if abs(turn) < 1e-9:
        return (x, y, turn)
    s, c = math.sin(turn) / turn, (1.0 - math.cos(turn)) / turn
    return (s * x - c * y, c * x + s * y, turn)


def _tuple(pose: PlanarMotion) -> Pose:
    return (pose.x, pose.y, pose.yaw)
