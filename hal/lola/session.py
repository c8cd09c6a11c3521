"""One connection to LoLA from its first message on: decode, decide, answer, publish."""

from __future__ import annotations

import contextlib
import time
from dataclasses import dataclass

import numpy as np

from hal.lola.actuators import encode_actuators
from hal.lola.core import Core, CoreState, Wanted
from hal.lola.layout import PERIOD_S
from hal.lola.link import Link, LinkError
from hal.lola.modes import Mode
from hal.lola.sensors import Sensors, decode_sensors
from hal.lola.shared import Shared, body_values
from hal.lola.standing import StandingState
from hal.nao.joints import JOINT_NAMES

LATE_NS = 8_000_000
"""After its reception, an answer is for the next cycle (`lola_protocol.yaml`, reply_deadline)."""

STEP_MAX_S = 3 * PERIOD_S
"""After a gap in LoLA's messages the targets go on from where they were, not from where they would
have been."""

SAFE_TICKS = 3
"""How often the last message is said, for nobody knows what LoLA does with one it has not read."""

HOT_FROM = 1.0
SOFT_RATIO = 0.5


@dataclass(slots=True)
class Counts:
    """Since the process started."""

    ticks: int = 0
    late: int = 0
    bad: int = 0
    connections: int = 0


class Session:
    """Holds the state of the tick between two messages."""

    def __init__(
        self, link: Link, core: Core[StandingState], shared: Shared, counts: Counts, resting: bool
    ) -> None:
        self._link, self._core, self._shared = link, core, shared
        self._counts = counts
        self._resting = resting
        self._before_ns = 0
        self._safe_ticks = 0
        self.state: CoreState[StandingState] | None = None
        self.sensors: Sensors | None = None

    @property
    def done(self) -> bool:
        """Whether the robot can be left alone, and LoLA has been told so often enough."""
        return self._safe_ticks >= SAFE_TICKS

    @property
    def mode(self) -> Mode | None:
        """What the robot is about; None before the first message."""
        return None if self.state is None else self.state.mode

    @property
    def resting(self) -> bool:
        """Whether it sat limp when it was last heard of."""
        return self._resting if self.state is None else self.mode == "rest"

    def tick(self, data: bytes, wanted: Wanted) -> None:
        """Answer a message. Raises MessageError, LinkError."""
        now_ns = time.monotonic_ns()
        sensors = decode_sensors(data)
        if self.state is None:
            self.state = self._core.begin(sensors, self._resting)
            dt_s = 0.0
        else:
            dt_s = min((now_ns - self._before_ns) / 1e9, STEP_MAX_S)
        self._before_ns, self.sensors = now_ns, sensors
        self.state, actuators = self._core.step(self.state, sensors, wanted, dt_s)
        self._link.send(encode_actuators(actuators))
        answered_ns = time.monotonic_ns()
        safe = self._core.done(self.state, sensors)
        self._safe_ticks = self._safe_ticks + 1 if safe else 0
        self._shared.put(now_ns, answered_ns, body_values(sensors))
        self._counts.ticks += 1
        self._counts.late += answered_ns - now_ns > LATE_NS

    def repeat(self) -> None:
        """Answer a message that cannot be read: as before."""
        if self.state is not None:
            with contextlib.suppress(LinkError):
                self._link.send(encode_actuators(self._core.actuators(self.state, alone=False)))

    def soft(self) -> tuple[str, ...]:
        """Joints that are much less stiff than they were told: heat, a fault, or a motor's own."""
        if self.state is None or self.sensors is None:
            return ()
        told = self.state.guard.stiffness
        less = (told > 0.0) & (self.sensors.stiffness < SOFT_RATIO * told)
        return tuple(JOINT_NAMES[i] for i in np.flatnonzero(less))

    def hot(self) -> tuple[str, ...]:
        """Joints whose motor says that it is."""
        if self.sensors is None:
            return ()
        return tuple(JOINT_NAMES[i] for i in np.flatnonzero(self.sensors.status >= HOT_FROM))
