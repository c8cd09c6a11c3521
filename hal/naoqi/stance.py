"""Whether the robot stands ready to walk, and its standing up."""

from __future__ import annotations

import logging
from collections.abc import Callable

from hal.errors import HalError
from hal.naoqi.errors import CallRefusedError, ServiceMissingError
from hal.naoqi.memory import Sensed
from hal.naoqi.readiness import Readiness, needs_rising, objection, read_readiness
from hal.naoqi.rising import Rising
from hal.naoqi.session import Session

log = logging.getLogger(__name__)

EVERY = 5
"""Turns from one asking to the next."""


class Stance:
    """What is known of it; not locked: its owner is."""

    def __init__(self, memory: Callable[[], Sensed], wake_up: bool) -> None:
        self._memory, self._wake_up = memory, wake_up
        self._rising: Rising | None = None
        self._turn = 0
        self.readiness = Readiness()

    @property
    def is_rising(self) -> bool:
        """Whether it is standing up."""
        return self._rising is not None

    @property
    def fallen(self) -> bool:
        """Fallen or lifted: a walk makes no sense."""
        return objection(self._memory()) is not None

    @property
    def lies(self) -> bool:
        """Fallen."""
        return self._memory().lies

    def refusal(self, *, walks: bool) -> str | None:
        """Why it cannot walk now; begins to stand up if that is what it takes and is allowed.

        `walks`: it does so already; then nobody knows its posture.
        """
        reason = objection(self._memory())
        if reason is not None:
            return reason
        if self._rising is not None:
            return "the robot is standing up; ask again when it stands"
        reason = None if walks else needs_rising(self.readiness)
        if reason is None or not self._wake_up:
            return reason
        self._rising = Rising()
        return f"{reason}: it stands up now; ask again when it stands"

    def cancel(self) -> None:
        """Stand up no further than the step under way."""
        if self._rising is not None:
            self._rising.cancel()

    def forget(self) -> None:
        """Another connection: what was under way is not ours any more."""
        self._rising = None

    def read(self, session: Session) -> None:
        """Ask the robot, now and then. Raises NotConnectedError or NoAnswerError."""
        if self._turn % EVERY == 0:
            self.readiness = read_readiness(session)
        self._turn += 1

    def rise(self, session: Session) -> None:
        """Go on standing up. Raises NotConnectedError or NoAnswerError."""
        if self._rising is None:
            return
        try:
            self._rising.turn(session)
        except (CallRefusedError, ServiceMissingError) as error:
            log.warning("standing up failed: %s", error)
        except HalError:
            self._rising = None
            raise
        if self._rising.is_over:
            self._rising = None
            self.readiness = read_readiness(session)
