"""The world's state, moved on in ticks of 10 ms, and its recorded past.

The recorded past always reaches a little beyond the present, so that any moment up to now lies
between two ticks. A command given now is felt from the next tick on.
"""

from __future__ import annotations

from collections.abc import Callable
from threading import RLock

import numpy as np

from hal.between import state_between
from hal.errors import MotionRefusedError
from hal.nao.joints import JOINT_INDEX
from hal.scenario import Scenario
from hal.types import BodyState, HeadAngles, NaoVersion
from sim_backend.floor import Floor
from sim_backend.head import HeadServo
from sim_backend.history import History
from sim_backend.poses import Pose
from sim_backend.sensors import Sensors
from sim_backend.snapshot import Snapshot, snapshot_between
from sim_backend.walk import SimWalk
from sim_backend.walk_model import Bearing, KinematicWalk, WalkModel

TICK_NS = 10_000_000
PAST_TICKS = 500
_YAW, _PITCH = JOINT_INDEX["HeadYaw"], JOINT_INDEX["HeadPitch"]


def pose_of(x: float, y: float, yaw_deg: float) -> Pose:
    """A pose of a scenario file, in radians."""
    return (x, y, float(np.radians(yaw_deg)))


def model_of(scenario: Scenario, seed: int) -> WalkModel:
    """The walk model a resolved scenario asks for, at its start."""
    start = pose_of(*scenario.robot.start)
    floor = Floor(seed, scenario.walk.slip_std, scenario.walk.yaw_drift, start)
    return KinematicWalk(floor, scenario.walk.push)


class World:
    """The robot in motion. All its methods take the lock, which is shared with the walk."""

    def __init__(
        self,
        scenario: Scenario,
        version: NaoVersion,
        seed: int,
        real_ns: Callable[[], int] | None = None,
    ) -> None:
        """`real_ns`: the machine's clock, if the world is to run along with it."""
        start_ns = 0 if real_ns is None else real_ns()
        self.lock = RLock()
        self._model = model_of(scenario, seed)
        self._head = HeadServo()
        self._sensors = Sensors(seed, version, TICK_NS / 1e9)
        self._past: History[Snapshot] = History(PAST_TICKS)
        self._measured: History[BodyState] = History(PAST_TICKS)
        self.start_ns = start_ns
        self.placed_ns = start_ns
        self._now_ns = start_ns
        self.walk = SimWalk(self._model, real_ns or (lambda: self._now_ns), self.lock)
        self._tick_ns = start_ns - TICK_NS
        self._run_to(start_ns)

    def run_to(self, now_ns: int) -> None:
        """The present is now `now_ns`: move the world on to it."""
        with self.lock:
            self._run_to(now_ns)

    def _run_to(self, now_ns: int) -> None:
        while self._tick_ns <= now_ns:
            self._now_ns = max(self._now_ns, min(self._tick_ns, now_ns))
            self.walk.run(self._tick_ns)
            self._head.run(TICK_NS / 1e9)
            bearing = self._model.run(TICK_NS / 1e9)
            self._tick_ns += TICK_NS
            self._record(bearing)
        self._now_ns = max(self._now_ns, now_ns)

    def _record(self, bearing: Bearing) -> None:
        angles = bearing.angles_rad.copy()
        angles[_YAW], angles[_PITCH] = self._head.angles.yaw_rad, self._head.angles.pitch_rad
        loads = (bearing.load_left, bearing.load_right)
        now = Snapshot(bearing.T_world_torso, angles, bearing.base, bearing.odometry, loads)
        self._past.append(self._tick_ns, now)
        self._measured.append(self._tick_ns, self._sensors.measure(self._tick_ns, now))

    def snapshot(self, stamp_ns: int) -> Snapshot | None:
        """The true state at a time; None outside the recorded past."""
        with self.lock:
            found = self._past.around(stamp_ns)
        return None if found is None else snapshot_between(*found)

    def present(self, now_ns: int) -> Snapshot:
        """The true state now."""
        with self.lock:
            found = self._past.around(min(now_ns, self._past.newest_ns))
        assert found is not None
        return snapshot_between(*found)

    def measured(self, stamp_ns: int, now_ns: int) -> BodyState | None:
        """The measurement at a time; None outside the recorded past."""
        with self.lock:
            found = self._measured.around(stamp_ns) if stamp_ns <= now_ns else None
        return None if found is None else state_between(*found, stamp_ns)

    def newest_measured(self, now_ns: int) -> BodyState:
        """The newest measurement."""
        with self.lock:
            found = self._measured.newest_until(now_ns)
        assert found is not None
        return found[1]

    def look(self, target: HeadAngles, speed_rad_s: float) -> HeadAngles:
        """Turn the head; raises MotionRefusedError."""
        with self.lock:
            if self._model.fallen:
                raise MotionRefusedError("the robot has fallen")
            return self._head.look(target, speed_rad_s)

    def knock_over(self) -> None:
        """Push the robot so that it falls."""
        with self.lock:
            self._model.knock_over()

    def place(self, pose: Pose, now_ns: int) -> None:
        """Carry the robot somewhere; its recorded past begins anew."""
        with self.lock:
            self.walk.stop()
            self._model.place(pose)
            self._head.straighten()
            self._sensors.forget()
            self._past.clear()
            self._measured.clear()
            self.placed_ns = now_ns
            # two states at rest, before and after now, so that now lies in the recorded past
            self._tick_ns -= TICK_NS
            while self._tick_ns > now_ns:
                self._tick_ns -= TICK_NS
            self._record(self._model.bearing())
            self._tick_ns += TICK_NS
            self._record(self._model.bearing())
