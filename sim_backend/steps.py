"""Step limits of NAOqi's walk, and the next step towards a velocity or a displacement. Pure.

Source of the figures: `naoqi_api.yaml`, move_config, and `walk_facts.yaml`, naoqi_gait. A step is
the displacement of the base from one landing to the next, seen in the base's own frame; the foot
that swings lands beside the new base.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from hal.types import PlanarMotion
from sim_backend.poses import Pose, between, compose

STEP_PERIOD_S = 0.42
"""MinStepPeriod: NAOqi's walk at full frequency."""
DOUBLE_SUPPORT_SHARE = 1.0 / 3.0
MAX_STEP_X_M = 0.040
MAX_STEP_Y_M = 0.140
MIN_SEPARATION_M = 0.088
FOOT_SEPARATION_M = 0.10
MAX_STEP_THETA_RAD = 0.349
INWARD_THETA_RAD = 0.15
"""Toes of NAOqi's footprint boxes meet near 0.2 rad at 0.10 m separation; some room is kept."""
TRAVEL_MAX_M = 10.0

OUTWARD_Y_M = MAX_STEP_Y_M - FOOT_SEPARATION_M
INWARD_Y_M = FOOT_SEPARATION_M - MIN_SEPARATION_M
VELOCITY_MAX = PlanarMotion(
    MAX_STEP_X_M / STEP_PERIOD_S,
    (OUTWARD_Y_M + INWARD_Y_M) / (2.0 * STEP_PERIOD_S),
    (MAX_STEP_THETA_RAD + INWARD_THETA_RAD) / (2.0 * STEP_PERIOD_S),
)
"""0.095 m/s, 0.062 m/s, 0.59 rad/s: one step outwards and one inwards make a cycle."""

_LEFT = 1
_DONE = 1e-9


@dataclass(frozen=True, slots=True)
class Velocity:
    """Walk on at this velocity (m/s, m/s, rad/s)."""

    value: Pose


@dataclass(frozen=True, slots=True)
class Target:
    """Walk to this pose of the base and stand there (odometry frame)."""

    base: Pose


Intent = Velocity | Target | None


def clipped_velocity(velocity: PlanarMotion) -> PlanarMotion:
    """The nearest velocity in the direction asked for: box first, then ellipse, as NAOqi clips."""
    top = VELOCITY_MAX
    shares = (velocity.x / top.x, velocity.y / top.y, velocity.yaw / top.yaw)
    if sum(share * share for share in shares) <= 1.0:
        return velocity
    a, b, c = _into_ellipse(tuple(min(max(share, -1.0), 1.0) for share in shares))
    return PlanarMotion(a * top.x, b * top.y, c * top.yaw)


def clipped_travel(step: PlanarMotion) -> PlanarMotion:
    """A displacement as `moveTo` takes it: at most half a turn, and not out of the room."""
    length = math.hypot(step.x, step.y)
    share = min(1.0, TRAVEL_MAX_M / length) if length > 0.0 else 1.0
    yaw = min(max(step.yaw, -math.pi), math.pi)
    return PlanarMotion(share * step.x, share * step.y, yaw)


def first_side(intent: Intent, base: Pose) -> int:
    """Which foot swings first: the one on the side the base goes or turns to; 1 left, -1 right."""
    way = _wanted(intent, base)
    lean = way[1] / OUTWARD_Y_M + way[2] / MAX_STEP_THETA_RAD
    return -_LEFT if lean < 0.0 else _LEFT


def next_step(intent: Intent, base: Pose, side: int) -> Pose:
    """The displacement of the next step from `base`, with the foot on `side` swinging."""
    if isinstance(intent, Velocity):
        return _velocity_step(intent.value, side)
    if isinstance(intent, Target):
        return _step_towards(between(base, intent.base), side)
    return (0.0, 0.0, 0.0)


def is_done(intent: Intent, base: Pose) -> bool:
    """Whether nothing is left to walk from `base`."""
    if isinstance(intent, Velocity):
        return False
    if isinstance(intent, Target):
        return max(abs(value) for value in between(base, intent.base)) < _DONE
    return True


def _wanted(intent: Intent, base: Pose) -> Pose:
    if isinstance(intent, Velocity):
        return intent.value
    return between(base, intent.base) if isinstance(intent, Target) else (0.0, 0.0, 0.0)


def _limits(value: float, side: int, outward: float, inward: float) -> float:
    """The limit for a step of this sign by the foot of this side."""
    return outward if value * side >= 0.0 else inward


def _velocity_step(velocity: Pose, side: int) -> Pose:
    """A cycle's way shared between the two feet in the proportion of their limits."""
    x, y, yaw = (value * STEP_PERIOD_S for value in velocity)
    y_limit = _limits(y, side, OUTWARD_Y_M, INWARD_Y_M)
    yaw_limit = _limits(yaw, side, MAX_STEP_THETA_RAD, INWARD_THETA_RAD)
    y_share = 2.0 * y_limit / (OUTWARD_Y_M + INWARD_Y_M)
    yaw_share = 2.0 * yaw_limit / (MAX_STEP_THETA_RAD + INWARD_THETA_RAD)
    return (x, y * y_share, yaw * yaw_share)


def _step_towards(rest: Pose, side: int) -> Pose:
    """As much of what is left as one step takes."""
    limits = (
        MAX_STEP_X_M,
        _limits(rest[1], side, OUTWARD_Y_M, INWARD_Y_M),
        _limits(rest[2], side, MAX_STEP_THETA_RAD, INWARD_THETA_RAD),
    )
    shares = tuple(
        min(max(value / limit, -1.0), 1.0) for value, limit in zip(rest, limits, strict=True)
    )
    a, b, c = _into_ellipse(shares)
    return (a * limits[0], b * limits[1], c * limits[2])


def _into_ellipse(shares: tuple[float, ...]) -> Pose:
    norm = math.sqrt(sum(share * share for share in shares))
    scale = 1.0 / norm if norm > 1.0 else 1.0
    return (shares[0] * scale, shares[1] * scale, shares[2] * scale)


def landing(base: Pose, side: int) -> Pose:
    """Where the foot of a side stands beside a base."""
    return compose(base, (0.0, side * FOOT_SEPARATION_M / 2.0, 0.0))
