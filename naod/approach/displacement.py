"""From what is seen to a bounded displacement of the base (equations 9 and 10)."""

from __future__ import annotations

import math

from hal.types import PlanarMotion
from naod.approach.goal import Goal
from naod.geometry.transforms import inverse, planar, wrap, yaw_of
from naod.localisation.ego import EgoPose
from naod.pose.objects import Cylinder, ObjectShape


def shape_kind(shape: ObjectShape) -> str:
    """ "cylinder" or "rectangle"."""
    return "cylinder" if isinstance(shape, Cylinder) else "rectangle"


def goal_from(kind: str, ego: EgoPose, sigma_m: float) -> Goal:
    """The goal that is shown by standing where `ego` was seen."""
    return Goal(
        kind=kind,
        rho_m=ego.rho_m,
        theta_rad=ego.theta_rad,
        z_m=ego.z_m,
        phi_rad=ego.phi_rad,
        sigma_m=sigma_m,
    )


def displacement(ego: EgoPose, goal: Goal) -> PlanarMotion:
    """T_base_goal = T_base_object T_object_goal, on the floor (equation 9).

    A cylinder has no front. Its axes are turned towards the base here, not the camera, so that the
    result does not depend on where the head points; at the goal both are the same.
    """
    if goal.kind == "cylinder":
        now = planar(ego.x_m, ego.y_m, ego.theta_rad)
        then = planar(_x(goal), _y(goal), goal.theta_rad)
    else:
        now = planar(ego.x_m, ego.y_m, ego.phi_rad)
        then = planar(_x(goal), _y(goal), goal.phi_rad)
    T_base_goal = now @ inverse(then)
    return PlanarMotion(float(T_base_goal[0, 3]), float(T_base_goal[1, 3]), yaw_of(T_base_goal))


def saturate(motion: PlanarMotion, rho_max_m: float, yaw_max_rad: float) -> PlanarMotion:
    """sat(d, lambda) of equation 10: direction kept, distance and turn each bounded."""
    rho = math.hypot(motion.x, motion.y)
    scale = 1.0 if rho <= rho_max_m else rho_max_m / rho
    yaw = min(max(wrap(motion.yaw), -yaw_max_rad), yaw_max_rad)
    return PlanarMotion(scale * motion.x, scale * motion.y, yaw)


def _x(goal: Goal) -> float:
    return goal.rho_m * math.cos(goal.theta_rad)


def _y(goal: Goal) -> float:
    return goal.rho_m * math.sin(goal.theta_rad)
