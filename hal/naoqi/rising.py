"""Standing up: motors on, posture, ready for a first step. Calls in turn, none waited for."""

from __future__ import annotations

import logging
import time

from hal.errors import HalError
from hal.naoqi.session import Call, Session

log = logging.getLogger(__name__)

STEP_S = 30.0
ANSWERED_S = 0.3
_STEPS: tuple[tuple[str, str, tuple[object, ...]], ...] = (
    ("ALMotion", "wakeUp", ()),
    ("ALRobotPosture", "goToPosture", ("StandInit", 0.5)),
    # without it the first move begins after a delay nobody knows
    ("ALMotion", "moveInit", ()),
)


class Rising:
    """Begun by a first walk; moved on by `turn`. A step that fails ends it."""

    def __init__(self) -> None:
        self._since_s = time.monotonic()
        self._left = list(_STEPS)
        self._call: Call | None = None

    @property
    def is_over(self) -> bool:
        """Whether nothing is left to do."""
        return self._call is None and not self._left

    def turn(self, session: Session) -> None:
        """Begin the next step if the one before is done. Raises HalError: then it is over."""
        try:
            if self._call is not None:
                if not self._call.done and self._call.age_s < STEP_S:
                    return
                call, self._call = self._call, None
                if call.result(0.0) is False:
                    raise HalError("the robot did not get into its posture")
            if self._left:
                service, method, args = self._left.pop(0)
                log.info("standing up: %s", method)
                self._call = session.post(service, method, *args)
        except HalError:
            self._left.clear()
            self._call = None
            raise

    def cancel(self) -> None:
        """Go no further than the step under way.

        A stop that comes at once is the walk server's answer to the refusal, and not meant.
        """
        if time.monotonic() - self._since_s > ANSWERED_S:
            self._left.clear()
