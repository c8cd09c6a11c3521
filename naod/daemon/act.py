"""Carrying out what a tick has decided."""

from __future__ import annotations

import logging

import msgspec

from hal.errors import HalError
from naod.bus import keys
from naod.bus.bus import Bus
from naod.daemon.desk import Desk
from naod.daemon.faults import Faults
from naod.daemon.store import Store
from naod.errors import InputError
from naod.loop.types import Commands, Label, Reply, Teach
from naod.messages import EventMessage, StateMessage
from naod.walk_server.head import HeadDesk

log = logging.getLogger(__name__)


class Actor:
    """The loop's hands: head, bus, state folder."""

    def __init__(self, bus: Bus, head: HeadDesk, store: Store, desk: Desk, faults: Faults) -> None:
        self._bus = bus
        self._head = head
        self._store = store
        self._desk = desk
        self._faults = faults
        self.last: StateMessage | None = None

    def carry_out(self, commands: Commands, now_ns: int) -> None:
        """Everything in one tick's commands; what fails is counted and shown."""
        if commands.walk is not None:
            self._bus.publish(keys.WALK_COMMAND, commands.walk)
        if commands.head is not None:
            try:
                self._head.track(commands.head, commands.head_speed_rad_s)
            except HalError as error:
                self.fault("head_failed", str(error), now_ns)
        replies = self._keep(commands, now_ns)
        self.tell(commands.state, now_ns)
        for event in commands.events:
            log.info("%s: %s", event.kind, event.message)
            self._bus.publish(keys.EVENT, event)
        self._desk.settle(replies)

    def tell(self, state: StateMessage, now_ns: int) -> None:
        """Publish the state with the faults of the shell added."""
        faults = tuple(sorted({*state.faults, *self._faults.present(now_ns)}))
        self.last = msgspec.structs.replace(state, faults=faults)
        self._bus.publish(keys.STATE, self.last)

    def fault(self, name: str, text: str, now_ns: int) -> bool:
        """Count a fault; say so, and return true, when it is news."""
        news = self._faults.add(name, now_ns)
        if news:
            log.error("%s: %s", name, text)
            message = f"{name}: {text}"[:300]
            event = EventMessage(stamp_ns=now_ns, kind="fault", message=message)
            self._bus.publish(keys.EVENT, event)
        return news

    def _keep(self, commands: Commands, now_ns: int) -> tuple[Reply, ...]:
        """Write what is to be kept; whoever asked for it learns if that failed."""
        replies = commands.replies
        try:
            if commands.keep_goal is not None:
                self._store.keep_goal(*commands.keep_goal)
        except InputError as error:
            self.fault("not_kept", str(error), now_ns)
            replies = self._spoilt(replies, Teach, str(error))
        try:
            if commands.keep_model is not None:
                self._store.keep_model(commands.keep_model)
        except InputError as error:
            self.fault("not_kept", str(error), now_ns)
            replies = self._spoilt(replies, Label, str(error))
        return replies

    def _spoilt(
        self, replies: tuple[Reply, ...], kind: type[Teach] | type[Label], why: str
    ) -> tuple[Reply, ...]:
        return tuple(
            Reply(reply.ticket, "not_kept", f"learnt, but not kept: {why}")
            if reply.error_code is None and isinstance(self._desk.verb_of(reply.ticket), kind)
            else reply
            for reply in replies
        )
