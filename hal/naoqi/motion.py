"""The motion under way, as we know it."""

from __future__ import annotations

import time
from dataclasses import dataclass, field

from hal.naoqi.lead import Lead
from hal.naoqi.session import Call
from hal.types import PlanarMotion

BEGIN_S = 1.5
"""NAOqi's preview is 0.8 s (`walk_facts.yaml`); if nothing has begun by then, nothing will."""


@dataclass(slots=True)
class Motion:
    """`told`: the velocity it is told, for a displacement the nominal one.

    `call` is a moveTo that returns at its end, or a move that returns at once; with a `lead` it is
    the newest of many moveTo.
    """

    told: PlanarMotion
    call: Call
    ends_itself: bool
    fired: int
    lead: Lead | None = None
    since_s: float = field(default_factory=time.monotonic)
    begun: bool = False

    def note_active(self, active: bool) -> None:
        """What moveIsActive said."""
        self.begun = self.begun or active

    def is_over(self, active: bool) -> bool:
        """Whether it has ended by itself, or never began."""
        if self.ends_itself and self.call.done:
            return self.lead is None or not active
        if active:
            return False
        return self.begun or time.monotonic() - self.since_s > BEGIN_S
