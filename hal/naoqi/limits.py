"""What a motion may be at most, before NAOqi clips it its own way."""

from __future__ import annotations

import math

from hal.errors import MotionRefusedError
from hal.naoqi.ids import SPEED_MAX, TRAVEL_MAX_M
from hal.types import PlanarMotion

STILL = PlanarMotion(0.0, 0.0, 0.0)


def check(motion: PlanarMotion, valid_for_s: float) -> None:
    """Raises MotionRefusedError for numbers that cannot be meant."""
    if not all(math.isfinite(value) for value in (motion.x, motion.y, motion.yaw)):
        raise MotionRefusedError(f"motion is not finite: {motion}")
    check_validity(valid_for_s)


def check_validity(valid_for_s: float) -> None:
    """Raises MotionRefusedError when it is not a time to come."""
    if not (math.isfinite(valid_for_s) and valid_for_s > 0.0):
        raise MotionRefusedError(f"a motion's validity is not positive: {valid_for_s} s")


def clipped_travel(step: PlanarMotion) -> PlanarMotion:
    """A displacement as `moveTo` takes it: a bounded way, at most half a turn."""
    length = math.hypot(step.x, step.y)
    share = min(1.0, TRAVEL_MAX_M / length) if length > 0.0 else 1.0
    yaw = min(max(step.yaw, -math.pi), math.pi)
    return PlanarMotion(share * step.x, share * step.y, yaw)


def clipped_velocity(velocity: PlanarMotion) -> PlanarMotion:
    """The velocity in the direction asked for, within the ellipse of the greatest ones."""
    norm = _norm(velocity)
    scale = 1.0 / norm if norm > 1.0 else 1.0
    return PlanarMotion(scale * velocity.x, scale * velocity.y, scale * velocity.yaw)


def nominal_velocity(step: PlanarMotion) -> PlanarMotion:
    """The velocity at which NAOqi goes a way: as fast as it can."""
    norm = _norm(step)
    return STILL if norm == 0.0 else PlanarMotion(step.x / norm, step.y / norm, step.yaw / norm)


def _norm(motion: PlanarMotion) -> float:
    values = (motion.x, motion.y, motion.yaw)
    return math.sqrt(sum((v / top) ** 2 for v, top in zip(values, SPEED_MAX, strict=True)))
