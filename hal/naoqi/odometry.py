"""Where the base has come since start-up, over restarts of the robot's own odometry."""

from __future__ import annotations

import math

from hal.errors import HalError
from hal.types import PlanarMotion

Pose = tuple[float, float, float]
_ORIGIN: Pose = (0.0, 0.0, 0.0)


class Odometry:
    """Poses of FRAME_WORLD in, the pose since our start-up out."""

    def __init__(self) -> None:
        self._first: Pose | None = None
        self._base: Pose = _ORIGIN
        self.pose = PlanarMotion(0.0, 0.0, 0.0)

    def restart(self) -> None:
        """The robot may count from another place now: go on from where we were."""
        self._base = (self.pose.x, self.pose.y, self.pose.yaw)
        self._first = None

    def take(self, measured: object) -> None:
        """getRobotPosition's answer. Raises HalError when it is not three finite numbers."""
        if not isinstance(measured, list | tuple) or len(measured) != 3:
            raise HalError(f"ALMotion gives no position: {measured!r:.60}")
        x, y, yaw = (float(value) for value in measured)
        if not all(map(math.isfinite, (x, y, yaw))):
            raise HalError("ALMotion gives a position that is not finite")
        now = (x, y, yaw)
        if self._first is None:
            self._first = now
        moved = composed(self._base, seen_from(self._first, now))
        self.pose = PlanarMotion(moved[0], moved[1], math.remainder(moved[2], 2.0 * math.pi))


def seen_from(a: Pose, b: Pose) -> Pose:
    """b seen from a."""
    c, s = math.cos(a[2]), math.sin(a[2])
    dx, dy = b[0] - a[0], b[1] - a[1]
    return (c * dx + s * dy, -s * dx + c * dy, b[2] - a[2])


def composed(a: Pose, b: Pose) -> Pose:
    """b, given as seen from a, in the frame of a."""
    c, s = math.cos(a[2]), math.sin(a[2])
    return (a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], a[2] + b[2])
