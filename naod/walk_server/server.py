"""The thread around the arbiter: commands from the bus in, motions to the robot out.

Every motion goes to the robot with a short deadline and is renewed at each tick, so that a walk
server that hangs is stopped by the robot itself (S2).
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable

from hal.errors import HalError
from hal.protocols import Robot
from hal.types import WalkStatus
from naod.bus import keys
from naod.bus.bus import Bus
from naod.bus.wire import RefusedError
from naod.messages import EventMessage, HeadCommand, StateMessage, WalkCommand, WalkState
from naod.pace import Pace
from naod.walk_server import arbiter
from naod.walk_server.actuate import carry_out
from naod.walk_server.head import HeadDesk
from naod.walk_server.inbox import Inbox
from naod.walk_server.latch import EstopLatch
from naod.walk_server.report import happened, report
from naod.walk_server.rules import Rules
from naod.walk_server.types import (
    Action,
    ArbiterState,
    End,
    Estop,
    Heartbeat,
    Input,
    Received,
    Release,
    Unreadable,
)

log = logging.getLogger(__name__)

PERIOD_NS = 40_000_000
SILENT_TICKS_MAX = 25
"""A robot that has not answered for so many ticks, one second, is lost."""

ANSWER_WITHIN_S = 1.0


class WalkServer:
    """Owns the robot's walk and the right to turn its head."""

    def __init__(self, robot: Robot, bus: Bus, rules: Rules, latch: EstopLatch) -> None:
        self._walk = robot.walk
        self._clock = robot.clock
        self._bus = bus
        self._rules = rules
        self._latch = latch
        self._state = ArbiterState(estopped=latch.is_set())
        self._inbox = Inbox()
        self._report: WalkState | None = None
        self._seq = 0
        self._silent = 0
        self._latching = threading.Lock()
        self._wake = threading.Event()
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._run, name="walk", daemon=True)
        self.head = HeadDesk(robot.head, robot.clock, lambda: self.estopped, rules)
        self.on_end: Callable[[], None] | None = None

    @property
    def estopped(self) -> bool:
        """Whether the estop is latched."""
        return self._state.estopped

    @property
    def refusals(self) -> int:
        """How many messages were refused since start-up."""
        return self._state.refusals

    def latest(self) -> WalkState | None:
        """What was published last."""
        return self._report

    def start(self) -> None:
        """Listen and begin to tick; the robot is told to stand first of all. Raises HalError."""
        self._advance(self._walk.status())
        self._bus.subscribe(keys.WALK_COMMAND, WalkCommand, self._on_command, self.refuse)
        self._bus.subscribe(keys.STATE, StateMessage, self._on_state, self.refuse)
        self._bus.subscribe(keys.HEAD_COMMAND, HeadCommand, self._on_head, self.refuse)
        self._thread.start()

    def close(self) -> None:
        """Stop the walk and the thread. May be called twice."""
        self._closing.set()
        self._wake.set()
        if self._thread.ident is not None:
            self._thread.join(timeout=1.0)

    def command(self, command: WalkCommand) -> str | None:
        """Give a command and wait for the verdict: None, or why it was refused."""
        return self._decided(Received(command, self._clock.now_ns()))

    def refuse(self, reason: str) -> None:
        """Count something that is no command, and show why."""
        self._inbox.put(Unreadable(reason))

    def estop(self) -> None:
        """Stop and latch. Raises InputError if the latch cannot be kept; it holds all the same."""
        self._decided(Estop())
        with self._latching:
            self._latch.set()
            # a release that was under way must not win over an estop that came after it
            if not self.estopped:
                self._decided(Estop())

    def release(self) -> None:
        """Unlatch. Raises InputError, and stays latched, if the file cannot be removed."""
        with self._latching:
            self._latch.clear()
            self._decided(Release())

    def end(self) -> None:
        """End whatever motion is under way, whoever's it is."""
        self._decided(End())

    def _on_command(self, command: WalkCommand) -> None:
        self._inbox.put(Received(command, self._clock.now_ns()))

    def _on_state(self, _state: StateMessage) -> None:
        self._inbox.put(Heartbeat(self._clock.now_ns()))

    def _on_head(self, command: HeadCommand) -> None:
        try:
            self.head.operate(command)
        except RefusedError as error:
            self.refuse(str(error))

    def _decided(self, item: Input) -> str | None:
        waiting = self._inbox.put(item)
        self._wake.set()
        if not waiting.decided.wait(ANSWER_WITHIN_S):
            return "the walk server does not answer"
        return waiting.verdict

    def _run(self) -> None:
        pace = Pace(self._clock.now_ns(), PERIOD_NS)
        try:
            while not self._closing.is_set():
                self._wake.wait(pace.left_s(self._clock.now_ns()))
                self._wake.clear()
                self._tick()
                pace.advance(self._clock.now_ns())
        finally:
            self._stop_whatever_happens()
            if self.on_end is not None:
                self.on_end()

    def _tick(self) -> None:
        try:
            status = self._walk.status()
        except HalError as error:
            self._silent += 1
            if self._silent == 1:
                log.error("the robot's walk does not answer: %s", error)
            self._stop_whatever_happens()
            if self._silent > SILENT_TICKS_MAX:
                raise
            return
        self._silent = 0
        self._advance(status)

    def _advance(self, status: WalkStatus) -> None:
        before, state = self._state, self._state
        taken = self._inbox.take()
        verdicts: list[str | None] = []
        for waiting in taken:
            refusals = state.refusals
            state = arbiter.receive(state, waiting.item, status, self._rules)
            verdicts.append(state.refused if state.refusals > refusals else None)
        state, action = arbiter.tick(state, status, self._clock.now_ns(), self._rules)
        self._state = self._obey(state, action)
        for waiting, verdict in zip(taken, verdicts, strict=True):
            waiting.settle(verdict)
        self._publish(before, status)

    def _obey(self, state: ArbiterState, action: Action | None) -> ArbiterState:
        if action is None:
            return state
        try:
            carry_out(self._walk, action)
        except HalError as error:
            log.warning("the robot refused %s: %s", action, error)
            return arbiter.refused_by_robot(state, str(error))
        return state

    def _publish(self, before: ArbiterState, status: WalkStatus) -> None:
        self._seq += 1
        last = self._report
        self._report = report(self._state, status, self._seq)
        self._bus.publish(keys.WALK_STATE, self._report)
        for kind, text in happened(before, self._state, last, self._report):
            event = EventMessage(stamp_ns=status.stamp_ns, kind=kind, message=text)
            self._bus.publish(keys.EVENT, event)

    def _stop_whatever_happens(self) -> None:
        try:
            self._walk.stop()
        except HalError as error:
            log.error("the robot could not be told to stop: %s", error)
