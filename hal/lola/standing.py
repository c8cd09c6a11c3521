"""The engine there is: holds a pose, stands up and sits down slowly, and does not walk."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hal.lola.engine import Aim, EngineCommand, EngineReport, Phase
from hal.lola.poses import HEAD, LEGS, SEAT, STAND
from hal.lola.sensors import Sensors

Array = NDArray[np.float64]

SPEED_RAD_S = 0.6
"""The fastest any joint goes on its way from pose to pose; assumed gentle, not published."""

FOLLOWS_WITHIN_RAD = 0.3
"""A leg joint that is further behind its target stops the way until it has caught up."""

NO_WALK = "LoLA takes joint angles only and no walking engine is installed: the robot stands"

_GOALS = {"stand": STAND, "sit": SEAT}
_PHASES: dict[Aim, tuple[Phase, Phase]] = {
    "hold": ("holding", "holding"),
    "stand": ("rising", "standing"),
    "sit": ("sitting", "seated"),
}


@dataclass(frozen=True, slots=True)
class StandingState:
    """On the way from one pose to another, (26,) each; at its end when all of it has elapsed."""

    aim: Aim
    start_rad: Array
    goal_rad: Array
    duration_s: float
    elapsed_s: float

    @property
    def there(self) -> bool:
        """Whether the targets have come to the goal."""
        return self.elapsed_s >= self.duration_s

    def targets(self) -> Array:
        """Where the joints are to be now: slow at both ends of the way."""
        if self.there:
            return self.goal_rad
        share = 0.5 - 0.5 * math.cos(math.pi * self.elapsed_s / self.duration_s)
        return self.start_rad + share * (self.goal_rad - self.start_rad)


class StandingEngine:
    """`hal.lola.engine.Engine` that refuses to walk."""

    def begin(self, sensors: Sensors) -> StandingState:
        """Hold the measured pose."""
        return _way("hold", sensors.angles_rad, sensors.angles_rad)

    def step(
        self, state: StandingState, sensors: Sensors, command: EngineCommand, dt_s: float
    ) -> tuple[StandingState, Array]:
        """A little further on the way to the pose that is aimed at."""
        if command.aim != state.aim:
            here = state.targets()
            state = _way(command.aim, here, _GOALS.get(command.aim, here))
        elif not state.there and _follows(state, sensors):
            state = replace(state, elapsed_s=state.elapsed_s + dt_s)
        return state, state.targets()

    def report(self, state: StandingState) -> EngineReport:
        """What it is at; it always refuses to walk."""
        under_way, there = _PHASES[state.aim]
        return EngineReport(there if state.there else under_way, not state.there, NO_WALK)


def _way(aim: Aim, start: Array, goal: Array) -> StandingState:
    change = np.abs(goal - start)
    change[HEAD] = 0.0
    # the cosine's steepest slope is pi/2 of its mean
    duration = 0.5 * math.pi * float(change.max()) / SPEED_RAD_S
    return StandingState(aim, start.copy(), goal.copy(), duration, 0.0)


def _follows(state: StandingState, sensors: Sensors) -> bool:
    behind = np.abs(state.targets() - sensors.angles_rad)[LEGS]
    return bool(behind.max() < FOLLOWS_WITHIN_RAD)
