"""SimWorld: the one service no robot has. The truth, and faults, for whoever tests against it."""

from __future__ import annotations

import math
import threading
from dataclasses import replace

import qi

from hal.types import PlanarMotion
from sim_backend.poses import wrapped
from sim_backend.speak.naoqi_robot import PeerRobot


@qi.multiThreaded()
class SimWorld:
    """Truth and faults."""

    def __init__(self, robot: PeerRobot, restart: threading.Event) -> None:
        self._robot, self._restart = robot, restart

    def truth(self) -> dict[str, object]:
        """As `sim/truth` on the bus: base [x, y, yaw], object [x, y, z, yaw]; what moves."""
        truth = self._robot.sim.truth()
        thing = truth.T_world_object
        yaw = math.atan2(thing[1, 2], thing[0, 2])
        status = self._robot.sim.walk.status()
        return {
            "base": [float(value) for value in (truth.base.x, truth.base.y, truth.base.yaw)],
            "object": [*(float(value) for value in thing[:3, 3]), wrapped(yaw)],
            "moving": status.moving,
            "velocity": [
                float(status.velocity.x),
                float(status.velocity.y),
                float(status.velocity.yaw),
            ],
        }

    def head(self) -> list[float]:
        """True head angles, now: yaw, pitch."""
        angles = self._robot.sim.body.latest().angles_rad
        return [float(angles[0]), float(angles[1])]

    def place(self, x: float, y: float, yaw: float) -> None:
        """Carry the robot somewhere."""
        self._robot.sim.place(PlanarMotion(float(x), float(y), float(yaw)))

    def reset(self) -> None:
        """Put up where it started, awake, refusing nothing."""
        self._robot.lifted = False
        with self._robot.lock:
            self._robot.refusals.clear()
        self._robot.sim.walk.stop()
        x, y, yaw_deg = self._robot.sim.scenario.robot.start
        self.place(x, y, math.radians(yaw_deg))
        self._robot.set_motors(True)

    def knockOver(self) -> None:
        """Let it fall."""
        self._robot.sim.knock_over()

    def lift(self, off_the_floor: bool) -> None:
        """Lift it, or put it down."""
        self._robot.lifted = bool(off_the_floor)

    def refuse(self, method: str, text: str) -> None:
        """Let "Service.method" raise this; an empty text lets it be."""
        with self._robot.lock:
            self._robot.refusals.pop(method, None)
            if text:
                self._robot.refusals[method] = text

    def calls(self, method: str) -> int:
        """How often "Service.method" was called."""
        return self._robot.calls.get(method, 0)

    def pictureTaken(self) -> int:
        """When the picture handed out last was taken, the middle of its exposure.

        In ns of the machine's monotonic clock, which all its processes share.
        """
        return self._robot.picture_ns

    def become(self, changes: dict[str, object]) -> None:
        """Change the peer's own options, by name, and restart."""
        missing = changes.get("missing", self._robot.told.missing)
        told = {**changes, "missing": tuple(missing)}  # type: ignore[arg-type]
        self._robot.told = replace(self._robot.told, **told)  # type: ignore[arg-type]
        self._restart.set()

    def restart(self) -> None:
        """As NAOqi does: every connection is cut, what was written is forgotten, the walk ends."""
        self._restart.set()
