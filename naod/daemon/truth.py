"""`sim/truth`: where things really are, for whoever judges from outside."""

from __future__ import annotations

import math
import threading

from hal.simulation import SimulatedRobot, Truth
from naod.bus import keys
from naod.bus.bus import Bus
from naod.messages import TruthMessage
from naod.pace import Pace

PERIOD_NS = 40_000_000


def truth_message(truth: Truth) -> TruthMessage:
    """The message; the object's yaw is the azimuth of its z axis."""
    T = truth.T_world_object
    x, y, z = (float(v) for v in T[:3, 3])
    yaw = math.atan2(float(T[1, 2]), float(T[0, 2]))
    base = truth.base
    return TruthMessage(
        stamp_ns=truth.stamp_ns, base=(base.x, base.y, base.yaw), object=(x, y, z, yaw)
    )


class TruthTeller:
    """Publishes the truth of a simulated robot from a thread of its own."""

    def __init__(self, robot: SimulatedRobot, bus: Bus) -> None:
        self._robot = robot
        self._bus = bus
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._run, name="truth", daemon=True)

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def close(self) -> None:
        """End. May be called twice."""
        self._closing.set()
        if self._thread.ident is not None:
            self._thread.join(timeout=1.0)

    def _run(self) -> None:
        clock = self._robot.clock
        pace = Pace(clock.now_ns(), PERIOD_NS)
        while not self._closing.wait(pace.left_s(clock.now_ns())):
            self._bus.publish(keys.TRUTH, truth_message(self._robot.truth()))
            pace.advance(clock.now_ns())
