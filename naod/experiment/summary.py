"""summary.json: what an experiment found, against the simulator's truth."""

from __future__ import annotations

import math

import msgspec

from hal.simulation import Truth
from naod.geometry.transforms import inverse, planar, wrap
from naod.localisation.ego import EgoPose, ego_pose

REACHED_M = 0.02
REACHED_RAD = math.radians(2.0)


class EgoRow(msgspec.Struct, frozen=True):
    """The ego-cylinder coordinates of the object (equation 6)."""

    rho_m: float
    theta_rad: float
    z_m: float
    phi_rad: float


class LocalisationRow(msgspec.Struct, frozen=True):
    """One look at the object: our estimate, the truth, and the printed estimator's answer."""

    t_s: float
    estimated: EgoRow
    true: EgoRow
    paper: EgoRow | None


class FinalError(msgspec.Struct, frozen=True, omit_defaults=True):
    """The base against the demonstrated pose.

    A cylinder looks the same from all sides, so the demonstrated pose is the one on the circle
    around it that is nearest; its distance, bearing and facing are given as well.
    """

    position_m: float
    yaw_rad: float
    distance_m: float | None = None
    bearing_rad: float | None = None
    facing_rad: float | None = None

    @property
    def reached(self) -> bool:
        """Within 2 cm and 2 degrees, in everything that can be seen."""
        turns = (self.yaw_rad, self.bearing_rad or 0.0, self.facing_rad or 0.0)
        return self.position_m <= REACHED_M and max(map(abs, turns)) <= REACHED_RAD


class Summary(msgspec.Struct, frozen=True):
    """The whole document; times in s, `wall_s` is real time."""

    converged: bool
    final_error: FinalError
    time_s: float
    moves: int
    fell: bool
    lost_count: int
    localisation: list[LocalisationRow]
    wall_s: float
    seed: int


def ego_row(ego: EgoPose) -> EgoRow:
    """As a row of the summary."""
    return EgoRow(ego.rho_m, ego.theta_rad, ego.z_m, ego.phi_rad)


def true_ego(truth: Truth) -> EgoPose:
    """The ego-cylinder coordinates as the simulator knows them."""
    base = truth.base
    return ego_pose(inverse(planar(base.x, base.y, base.yaw)) @ truth.T_world_object)


def final_error(kind: str, shown: Truth, end: Truth) -> FinalError:
    """How far the base is from where it stood when the goal was shown."""
    if kind == "cylinder":
        return _around_axis(true_ego(shown), true_ego(end))
    position = math.hypot(end.base.x - shown.base.x, end.base.y - shown.base.y)
    return FinalError(position, wrap(end.base.yaw - shown.base.yaw))


def _around_axis(shown: EgoPose, end: EgoPose) -> FinalError:
    distance = end.rho_m - shown.rho_m
    bearing = wrap(end.theta_rad - shown.theta_rad)
    facing = wrap(end.phi_rad - shown.phi_rad)
    # turning the base by -bearing brings the object to the azimuth at which it was shown
    return FinalError(abs(distance), -bearing, distance, bearing, facing)


def true_object_yaw(truth: Truth) -> float:
    """Azimuth in the world of the object's z axis, out of its face."""
    return math.atan2(float(truth.T_world_object[1, 2]), float(truth.T_world_object[0, 2]))
