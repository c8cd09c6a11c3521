"""Whether the way to the goal is known well enough to be walked."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hal.types import PlanarMotion
from naod.approach.displacement import displacement
from naod.approach.goal import Goal
from naod.localisation.looks import Look


@dataclass(frozen=True, slots=True)
class Doubt:
    """Standard deviations of a displacement: along its direction, and of its turn."""

    sigma_m: float
    sigma_rad: float


@dataclass(frozen=True, slots=True)
class Tolerance:
    """What is near enough."""

    m: float
    rad: float


def doubt_of(look: Look, goal: Goal, tolerance: Tolerance) -> Doubt:
    """How unsure the displacement to the goal is.

    Within the tolerance the direction says nothing; the worst one counts.
    """
    error = displacement(look.ego, goal)
    covariance = displacement_covariance(look, goal)
    length = math.hypot(error.x, error.y)
    if length > tolerance.m:
        along = np.array([error.x, error.y]) / length
        variance = float(along @ covariance[:2, :2] @ along)
    else:
        variance = float(np.linalg.eigvalsh(covariance[:2, :2])[-1])
    return Doubt(math.sqrt(max(variance, 0.0)), math.sqrt(max(float(covariance[2, 2]), 0.0)))


def displacement_covariance(look: Look, goal: Goal) -> NDArray[np.float64]:
    """(3, 3) of x, y (m) and yaw (rad) of `displacement` to first order, from all of the look's.

    The goal itself is taken as it is: what leans the camera leant it when the goal was shown too.
    """
    ego, way = look.ego, displacement(look.ego, goal)
    turn = np.array([0.0, 0.0, 0.0, 1.0])
    if goal.kind == "cylinder":
        square = max(ego.rho_m, 1e-6) ** 2
        turn = np.array([-ego.y_m / square, ego.x_m / square, 0.0, 0.0])
    J = np.zeros((3, 4))
    J[0, 0] = J[1, 1] = 1.0
    # the base turned about the object: t = p - R(yaw) g, so dt = -J R(yaw) g dyaw
    J[0] += (ego.y_m - way.y) * turn
    J[1] -= (ego.x_m - way.x) * turn
    J[2] = turn
    return np.asarray(J @ look.total @ J.T, dtype=np.float64)


def is_known(step: PlanarMotion, doubt: Doubt, tolerance: Tolerance) -> bool:
    """Whether neither the way nor the turn is less than its own uncertainty.

    What is smaller than the tolerance need only be known to the tolerance.
    """
    way_known = doubt.sigma_m <= max(math.hypot(step.x, step.y), tolerance.m)
    return way_known and doubt.sigma_rad <= max(abs(step.yaw), tolerance.rad)


def known_part(step: PlanarMotion, doubt: Doubt) -> PlanarMotion:
    """The step, each part shortened to what may be expected of it.

    Among ways that are normally distributed with deviation d, those measured as d with an error of
    deviation sigma are d^3 / (d^2 + sigma^2) long on average.
    """
    way = _share(math.hypot(step.x, step.y), doubt.sigma_m)
    return PlanarMotion(
        way * step.x, way * step.y, _share(abs(step.yaw), doubt.sigma_rad) * step.yaw
    )


def _share(size: float, sigma: float) -> float:
    square = size * size
    total = square + sigma * sigma
    return square / total if total > 0.0 else 0.0
