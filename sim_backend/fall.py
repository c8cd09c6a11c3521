"""Falling forwards over the toes, as far as the floor lets it."""

from __future__ import annotations

import math

from sim_backend.poses import Matrix, moved, rot_y, transform

FALL_S = 0.6
LYING_RAD = math.radians(88.0)
TOES_M = 0.10


def tilt_after(time_s: float) -> float:
    """Angle so long after it lost its balance: slowly at first, as a pendulum falls."""
    share = min(max(time_s / FALL_S, 0.0), 1.0)
    return LYING_RAD * share * share


def tilted(T_base_torso: Matrix, angle: float) -> Matrix:
    """The torso in the base frame after a turn about the toes' edge."""
    over = moved(TOES_M, 0.0, 0.0) @ transform(rot_y(angle), (0.0, 0.0, 0.0))
    return over @ moved(-TOES_M, 0.0, 0.0) @ T_base_torso
