"""The robot's true state at one moment, and between two."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim_backend.poses import Matrix, Pose, interpolated, mixed


@dataclass(frozen=True, slots=True)
class Snapshot:
    """Truth at one tick.

    `T_world_torso` (4, 4); `angles_rad` (26,); `base` in the world; `odometry` as believed;
    `loads`: shares of the weight on the left and the right foot.
    """

    T_world_torso: Matrix
    angles_rad: NDArray[np.float64]
    base: Pose
    odometry: Pose
    loads: tuple[float, float]


def snapshot_between(a: Snapshot, b: Snapshot, share: float) -> Snapshot:
    """The state between two ticks."""
    if share <= 0.0 or a is b:
        return a
    rest = 1.0 - share
    return Snapshot(
        interpolated(a.T_world_torso, b.T_world_torso, share),
        rest * a.angles_rad + share * b.angles_rad,
        mixed(a.base, b.base, share),
        mixed(a.odometry, b.odometry, share),
        (rest * a.loads[0] + share * b.loads[0], rest * a.loads[1] + share * b.loads[1]),
    )
