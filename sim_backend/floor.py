"""How the robot really gets on over the floor: slip, drift and a push.

The gait knows the odometry frame only. Slip moves the whole robot in the world, so that its joint
angles and its feet always agree.
"""

from __future__ import annotations

from sim_backend.poses import ORIGIN, Pose, between, compose
from sim_backend.streams import Purpose, stream

PUSH_AFTER_S = 2.0
"""The scenario's push comes so long after the robot first starts to walk, from its right side."""
PUSH_LASTS_S = 0.3
FALL_PUSH_N_S = 2.0
"""None fell at 1.5 N s, most above 2.2 (walk_engine.md)."""
PUSH_SHIFT_M_PER_N_S = 0.02


class Floor:
    """The true pose of the gait's reference, and with it of the whole odometry frame."""

    def __init__(self, seed: int, slip_std: float, yaw_drift: float, start: Pose) -> None:
        self._seed = seed
        self._slip_std = slip_std
        self._yaw_drift = yaw_drift
        self._moves = 0
        self._scale = (1.0, 1.0, 1.0)
        self._reference = ORIGIN
        self._in_world = start
        self._shove_m_s = 0.0
        self._shove_left_s = 0.0

    @property
    def world_odom(self) -> Pose:
        """Where the odometry frame is in the world now."""
        return compose(self._in_world, between(self._reference, ORIGIN))

    def new_move(self) -> None:
        """Draw the slip of the next move."""
        rng = stream(self._seed, Purpose.SLIP, self._moves)
        self._moves += 1
        x, y, yaw = 1.0 + self._slip_std * rng.standard_normal(3)
        self._scale = (float(x), float(y), float(yaw))

    def carry_to(self, pose: Pose, reference: Pose) -> None:
        """The robot is put down so that its reference is at a pose of the world."""
        self._in_world, self._reference = pose, reference
        self._shove_left_s = 0.0

    def shove(self, impulse_n_s: float) -> None:
        """A push from the right that it withstands, at the price of its place."""
        self._shove_m_s = PUSH_SHIFT_M_PER_N_S * impulse_n_s / PUSH_LASTS_S
        self._shove_left_s = PUSH_LASTS_S

    def run(self, reference: Pose, dt: float) -> None:
        """The gait's reference has moved to `reference` in the odometry frame in `dt` seconds."""
        x, y, yaw = between(self._reference, reference)
        way = (x * x + y * y) ** 0.5
        real = (
            x * self._scale[0],
            y * self._scale[1] + self._pushed(dt),
            yaw * self._scale[2] + self._yaw_drift * way,
        )
        self._in_world = compose(self._in_world, real)
        self._reference = reference

    def _pushed(self, dt: float) -> float:
        part = min(dt, self._shove_left_s)
        self._shove_left_s -= part
        return self._shove_m_s * part
