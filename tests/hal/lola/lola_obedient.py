"""A robot for the pure tests that does at once what it is told where it is stiff."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from lola_sensed import DT, sensed

from hal.lola.actuators import Actuators
from hal.lola.core import Core, CoreState, Wanted
from hal.lola.poses import STAND
from hal.lola.sensors import Sensors
from hal.lola.standing import StandingEngine, StandingState

CORE = Core(StandingEngine())
NOTHING = Wanted()


@dataclass
class Robot:
    """A robot that does at once what it is told where it is stiff."""

    angles: np.ndarray = field(default_factory=STAND.copy)
    stiffness: np.ndarray = field(default_factory=lambda: np.zeros(26))
    state: CoreState[StandingState] | None = None
    sent: Actuators | None = None
    more: dict = field(default_factory=dict)

    def sensors(self) -> Sensors:
        return sensed(self.angles, stiffness=self.stiffness, **self.more)

    def tick(self, wanted: Wanted = NOTHING, times: int = 1) -> Actuators:
        for _ in range(times):
            sensors = self.sensors()
            dt = DT if self.state is not None else 0.0
            if self.state is None:
                self.state = CORE.begin(sensors)
            self.state, self.sent = CORE.step(self.state, sensors, wanted, dt)
            held = self.sent.stiffness > 0.0
            self.angles = np.where(held, self.sent.angles_rad, self.angles)
            self.stiffness = self.sent.stiffness.copy()
        assert self.sent is not None
        return self.sent

    def press(self, ticks: int = 10) -> None:
        self.more["button"] = True
        self.tick(times=ticks)
        self.more["button"] = False
        self.tick()
