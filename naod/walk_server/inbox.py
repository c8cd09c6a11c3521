"""What waits for the walk server's next tick: bounded, and the newest survives a flood."""

from __future__ import annotations

import threading
from dataclasses import dataclass, field

from naod.walk_server.types import Heartbeat, Input, Received, Unreadable

WAITING_MAX = 64


@dataclass(slots=True)
class Waiting:
    """An input on its way; once `decided` is set, `verdict` says why it was refused, if it was."""

    item: Input
    decided: threading.Event = field(default_factory=threading.Event)
    verdict: str | None = None

    def settle(self, verdict: str | None) -> None:
        """Tell whoever waits."""
        self.verdict = verdict
        self.decided.set()


class Inbox:
    """Filled from any thread, emptied by one."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._waiting: list[Waiting] = []
        self._heartbeat: Heartbeat | None = None
        self._dropped = 0

    def put(self, item: Input) -> Waiting:
        """Add an input; in a flood the oldest message goes, never an estop."""
        waiting = Waiting(item)
        with self._lock:
            if isinstance(item, Heartbeat):
                self._heartbeat = item
                return waiting
            if len(self._waiting) >= WAITING_MAX:
                self._drop()
            self._waiting.append(waiting)
        return waiting

    def take(self) -> list[Waiting]:
        """Everything that waits, oldest first."""
        with self._lock:
            taken, self._waiting = self._waiting, []
            if self._dropped:
                flood = Unreadable("too many messages at once", self._dropped)
                taken.insert(0, Waiting(flood))
                self._dropped = 0
            if self._heartbeat is not None:
                taken.insert(0, Waiting(self._heartbeat))
                self._heartbeat = None
        return taken

    def _drop(self) -> None:
        for place, waiting in enumerate(self._waiting):
            if isinstance(waiting.item, (Received, Unreadable)):
                del self._waiting[place]
                self._dropped += 1
                waiting.settle("too many messages at once")
                return
