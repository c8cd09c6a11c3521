"""Where a walking engine plugs in: a pure function from what is measured and wanted to targets.

The process calls it once for each of LoLA's messages, every 12 ms. What it returns still goes
through `guard`, which knows the joints' limits, speeds and stiffness; the head is not its affair.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from hal.lola.sensors import Sensors
from hal.types import PlanarMotion

Array = NDArray[np.float64]
Aim = Literal["hold", "stand", "sit"]
Phase = Literal["holding", "rising", "standing", "sitting", "seated"]
STILL = PlanarMotion(0.0, 0.0, 0.0)
S = TypeVar("S")


@dataclass(frozen=True, slots=True)
class Motion:
    """A walk that is wanted now; its deadline has not passed.

    A velocity in m/s, m/s, rad/s, or a displacement in m, m, rad of the base from where it was when
    this `number` was first seen.
    """

    kind: Literal["velocity", "step"]
    number: int
    value: PlanarMotion


@dataclass(frozen=True, slots=True)
class EngineCommand:
    """The posture to be in, and the walk on top of it; None to stand still."""

    aim: Aim = "hold"
    motion: Motion | None = None


@dataclass(frozen=True, slots=True)
class EngineReport:
    """What the engine is at. `refusal`: why it would not walk now; None if it would.

    `moving` until both feet stand and the posture is reached. `odometry`: the base since `begin`.
    """

    phase: Phase
    moving: bool
    refusal: str | None
    velocity: PlanarMotion = STILL
    odometry: PlanarMotion = STILL


class Engine(Protocol[S]):
    """Keeps nothing itself: whatever it has to remember is its state."""

    def begin(self, sensors: Sensors) -> S:
        """The state that holds the measured pose."""
        ...

    def step(
        self, state: S, sensors: Sensors, command: EngineCommand, dt_s: float
    ) -> tuple[S, Array]:
        """Move on by `dt_s`; joint targets (26,), rad, order of `JOINT_NAMES`."""
        ...

    def report(self, state: S) -> EngineReport:
        """What it is at."""
        ...
