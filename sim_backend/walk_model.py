"""Models of walking: what a model must answer, and the kinematic one.

A dynamic model (motors, contacts, a walking engine on top) answers the same questions.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sim_backend.fall import tilt_after, tilted
from sim_backend.floor import FALL_PUSH_N_S, PUSH_AFTER_S, Floor
from sim_backend.gait import Gait
from sim_backend.poses import Matrix, Pose, compose, inverse, planar
from sim_backend.stance import Posed, posed
from sim_backend.steps import STEP_PERIOD_S, Intent, Target, Velocity, next_step


@dataclass(frozen=True, slots=True)
class Bearing:
    """The body below the neck at one moment.

    `T_world_torso` (4, 4); `angles_rad` (26,), head zero; `base` true, in the world; `odometry`
    what it believes; `load_left`, `load_right`: shares of the weight.
    """

    T_world_torso: Matrix
    angles_rad: NDArray[np.float64]
    base: Pose
    odometry: Pose
    load_left: float
    load_right: float


class WalkModel(Protocol):
    """A way of walking. Holds no clock."""

    @property
    def standing(self) -> bool: ...
    @property
    def fallen(self) -> bool: ...
    def believed_base(self) -> Pose: ...
    def told_velocity(self) -> Pose: ...
    def is_walking_to(self) -> bool: ...
    def command(self, intent: Intent, *, new_move: bool) -> None: ...
    def halt(self) -> None: ...
    def knock_over(self) -> None: ...
    def place(self, pose: Pose) -> None: ...
    def run(self, dt: float) -> Bearing: ...
    def bearing(self) -> Bearing: ...


class KinematicWalk:
    """Feet and body are put where the gait has them; the floor decides how far that gets it."""

    def __init__(self, floor: Floor, push_n_s: float) -> None:
        self._floor = floor
        self._push_n_s = push_n_s
        self._walked_s: float | None = None
        self._fallen_s: float | None = None
        self._gait = Gait()

    @property
    def standing(self) -> bool:
        """Both feet stand and nothing is about to move; also when it lies."""
        return self._gait.standing or self.fallen

    @property
    def fallen(self) -> bool:
        """It has lost its balance."""
        return self._fallen_s is not None

    def believed_base(self) -> Pose:
        """Where its odometry has the base now."""
        return self._gait.reference()

    def told_velocity(self) -> Pose:
        """What it is told to do, m/s, m/s, rad/s; zero if it has been told to stop."""
        intent = None if self.fallen else self._gait.intent
        if isinstance(intent, Velocity):
            return intent.value
        if isinstance(intent, Target):
            side = 1 if self._gait.step is None else -self._gait.step.side
            x, y, yaw = next_step(intent, self._gait.base, side)
            return (x / STEP_PERIOD_S, y / STEP_PERIOD_S, yaw / STEP_PERIOD_S)
        return (0.0, 0.0, 0.0)

    def is_walking_to(self) -> bool:
        """Whether it still has something to walk to."""
        return self._gait.intent is not None and not self.fallen

    def command(self, intent: Intent, *, new_move: bool) -> None:
        """Walk like this; a new move slips in its own way."""
        if new_move or self._gait.standing:
            self._floor.new_move()
        self._gait.command(intent)
        if self._walked_s is None:
            self._walked_s = 0.0

    def halt(self) -> None:
        """End on both feet as soon as is safe."""
        self._gait.halt()

    def knock_over(self) -> None:
        """Fall, now."""
        if self._fallen_s is None:
            self._fallen_s = 0.0

    def place(self, pose: Pose) -> None:
        """Carried somewhere and put down, standing; the odometry knows nothing of it."""
        self._gait = self._gait.stood_up()
        self._fallen_s = None
        self._floor.carry_to(pose, self._gait.reference())

    def run(self, dt: float) -> Bearing:
        """Move on by `dt` seconds."""
        if self._fallen_s is not None:
            self._fallen_s += dt
            return self.bearing()
        self._gait.run(dt)
        self._pushed(dt)
        self._floor.run(self._gait.reference(), dt)
        return self.bearing()

    def _pushed(self, dt: float) -> None:
        if self._walked_s is None or self._push_n_s <= 0.0:
            return
        self._walked_s += dt
        if self._walked_s < PUSH_AFTER_S:
            return
        if self._push_n_s >= FALL_PUSH_N_S:
            self.knock_over()
        else:
            self._floor.shove(self._push_n_s)
        self._push_n_s = 0.0

    def bearing(self) -> Bearing:
        """The body as it is now."""
        body = posed(self._gait)
        world_odom = self._floor.world_odom
        T_world_torso = planar(world_odom) @ body.T_odom_torso
        base = compose(world_odom, body.base)
        left, right = body.load_left, 1.0 - body.load_left
        if self._fallen_s is not None:
            T_world_torso = self._lying(body, base, self._fallen_s)
            left = right = 0.0
        return Bearing(T_world_torso, body.angles_rad, base, body.base, left, right)

    @staticmethod
    def _lying(body: Posed, base: Pose, since_s: float) -> Matrix:
        T_base_torso = inverse(planar(body.base)) @ body.T_odom_torso
        return planar(base) @ tilted(T_base_torso, tilt_after(since_s))
