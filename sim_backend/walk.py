"""The walk primitive: commands checked, clipped and given a deadline."""

from __future__ import annotations

import math
from collections.abc import Callable
from threading import RLock

from hal.errors import MotionRefusedError
from hal.types import PlanarMotion, WalkStatus
from sim_backend.poses import compose, wrapped
from sim_backend.steps import Target, Velocity, clipped_travel, clipped_velocity
from sim_backend.walk_model import WalkModel

_STILL = PlanarMotion(0.0, 0.0, 0.0)


class SimWalk:
    """`hal.protocols.Walk` on a walk model. `run` is called by the world at every tick."""

    def __init__(self, model: WalkModel, now_ns: Callable[[], int], lock: RLock) -> None:
        self._model = model
        self._now_ns = now_ns
        self._lock = lock
        self._deadline_ns: int | None = None

    def move_to(self, step: PlanarMotion, valid_for_s: float) -> PlanarMotion:
        """Walk by a displacement; see `hal.protocols.Walk`."""
        with self._lock:
            deadline_ns = self._checked(step, valid_for_s)
            sent = clipped_travel(step)
            target = compose(self._model.believed_base(), (sent.x, sent.y, sent.yaw))
            self._model.command(Target(target), new_move=True)
            self._deadline_ns = deadline_ns
            return sent

    def set_velocity(self, velocity: PlanarMotion, valid_for_s: float) -> PlanarMotion:
        """Walk at a velocity; see `hal.protocols.Walk`."""
        with self._lock:
            deadline_ns = self._checked(velocity, valid_for_s)
            sent = clipped_velocity(velocity)
            if sent == _STILL:
                self._end()
                return sent
            intent = Velocity((sent.x, sent.y, sent.yaw))
            self._model.command(intent, new_move=False)
            self._deadline_ns = deadline_ns
            return sent

    def renew(self, valid_for_s: float) -> None:
        """Let the present motion go on; see `hal.protocols.Walk`."""
        with self._lock:
            deadline_ns = self._deadline(valid_for_s)
            if self._model.is_walking_to():
                self._deadline_ns = deadline_ns

    def stop(self) -> None:
        """End on both feet as soon as is safe."""
        with self._lock:
            self._end()

    def status(self) -> WalkStatus:
        """What the walk does now."""
        with self._lock:
            odometry = self._model.bearing().odometry
            return WalkStatus(
                stamp_ns=self._now_ns(),
                moving=not self._model.standing or self._model.is_walking_to(),
                fallen=self._model.fallen,
                velocity=PlanarMotion(*self._model.told_velocity()),
                odometry=PlanarMotion(odometry[0], odometry[1], wrapped(odometry[2])),
            )

    def run(self, at_ns: int) -> None:
        """End the motion if its deadline has passed."""
        if self._deadline_ns is not None and at_ns >= self._deadline_ns:
            self._end()

    def _end(self) -> None:
        self._deadline_ns = None
        if not self._model.fallen:
            self._model.halt()

    def _checked(self, motion: PlanarMotion, valid_for_s: float) -> int:
        if not all(math.isfinite(value) for value in (motion.x, motion.y, motion.yaw)):
            raise MotionRefusedError(f"motion is not finite: {motion}")
        if self._model.fallen:
            raise MotionRefusedError("the robot has fallen")
        return self._deadline(valid_for_s)

    def _deadline(self, valid_for_s: float) -> int:
        if not (math.isfinite(valid_for_s) and valid_for_s > 0.0):
            raise MotionRefusedError(f"a motion's validity is not positive: {valid_for_s} s")
        return self._now_ns() + round(valid_for_s * 1e9)
