"""Who turns the head: an operator while the ttl of `head/command` lasts, else the tracker."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from dataclasses import dataclass

from hal.errors import HalError
from hal.protocols import Clock, Head
from hal.types import HeadAngles
from naod.bus.wire import RefusedError
from naod.messages import TRACKER, HeadCommand
from naod.walk_server.rules import TURN_RANGE, Rules
from naod.walk_server.sources import NOBODY, take

OPERATOR_SPEED_RAD_S = 1.5


@dataclass(frozen=True, slots=True)
class Hold:
    """Who holds the head, and until when."""

    source: str
    until_ns: int


class HeadDesk:
    """The one way to the head's joints. Safe to call from any thread."""

    def __init__(
        self, head: Head, clock: Clock, frozen: Callable[[], bool], rules: Rules | None = None
    ) -> None:
        self._head = head
        self._clock = clock
        self._frozen = frozen
        self._rules = rules or Rules()
        self._lock = threading.Lock()
        self._hold: Hold | None = None
        self._last = NOBODY

    def operate(self, command: HeadCommand) -> HeadAngles:
        """Turn to where a message says; the angles after clipping. Raises RefusedError."""
        target = HeadAngles(command.yaw, command.pitch)
        with self._lock:
            now_ns = self._clock.now_ns()
            reason = self._objection(command, now_ns)
            if reason is not None:
                raise RefusedError(f"{command.source}: head: {reason}")
            if command.source != TRACKER:
                self._hold = Hold(command.source, now_ns + command.ttl_ms * 1_000_000)
            try:
                return self._head.look(target, OPERATOR_SPEED_RAD_S)
            except HalError as error:
                raise RefusedError(f"{command.source}: head: {error}") from None

    def track(self, target: HeadAngles, speed_rad_s: float) -> HeadAngles | None:
        """The tracker's own wish; None when it does not have the head. Raises HalError."""
        with self._lock:
            if self._frozen() or self._holder(self._clock.now_ns()) is not None:
                return None
            return self._head.look(target, speed_rad_s)

    def _holder(self, now_ns: int) -> str | None:
        held = self._hold
        return held.source if held is not None and now_ns < held.until_ns else None

    def _objection(self, command: HeadCommand, now_ns: int) -> str | None:
        last = take(self._last, command.source, command.seq, now_ns, self._rules)
        if isinstance(last, str):
            return last
        self._last = last
        for name, value in (("yaw", command.yaw), ("pitch", command.pitch)):
            if not math.isfinite(value):
                return f"{name} is not a finite number"
            if abs(value) > TURN_RANGE:
                return f"{name} = {value:g} is out of range (at most {TURN_RANGE:g})"
        if self._frozen():
            return "estop is latched"
        holder = self._holder(now_ns)
        if holder is not None and holder != command.source:
            return f"{holder} holds the head"
        return None
