"""Requests between the bus and the loop: handed in by callers, answered by the loop's replies."""

from __future__ import annotations

import threading
from collections.abc import Iterable
from dataclasses import dataclass

from naod.bus.bus import Answer
from naod.loop.types import Reply, Request, Verb

OPEN_MAX = 16
PATIENCE_NS = 30_000_000_000


@dataclass(frozen=True, slots=True)
class _Open:
    verb: Verb
    answer: Answer | None
    until_ns: int


class Desk:
    """Every request gets exactly one answer, sooner or later. Safe to use from any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._ticket = 0
        self._new: list[Request] = []
        self._open: dict[int, _Open] = {}

    def ask(self, verb: Verb, answer: Answer | None, now_ns: int) -> None:
        """Hand in a request; without an answer nobody waits for it."""
        with self._lock:
            full = len(self._open) >= OPEN_MAX
            if not full or answer is None:
                self._ticket += 1
                self._new.append(Request(self._ticket, verb))
                self._open[self._ticket] = _Open(verb, answer, now_ns + PATIENCE_NS)
        if full and answer is not None:
            answer.error("busy", f"{OPEN_MAX} requests are waiting already")

    def take(self) -> tuple[Request, ...]:
        """The requests that have come since the last tick."""
        with self._lock:
            taken, self._new = tuple(self._new), []
        return taken

    def verb_of(self, ticket: int) -> Verb | None:
        """What a ticket was for, while it is open."""
        with self._lock:
            found = self._open.get(ticket)
        return found.verb if found else None

    def settle(self, replies: Iterable[Reply]) -> None:
        """Give answers."""
        for reply in replies:
            self._answer(reply)

    def expire(self, now_ns: int) -> None:
        """Give up on requests that nobody answered."""
        with self._lock:
            late = [ticket for ticket, o in self._open.items() if now_ns > o.until_ns]
        self.settle(Reply(ticket, "timeout", "the loop did not answer in time") for ticket in late)

    def fail_all(self, code: str, message: str) -> None:
        """Refuse everything that is open."""
        with self._lock:
            tickets = list(self._open)
            self._new.clear()
        self.settle(Reply(ticket, code, message) for ticket in tickets)

    def _answer(self, reply: Reply) -> None:
        with self._lock:
            found = self._open.pop(reply.ticket, None)
        if found is None or found.answer is None:
            return
        if reply.error_code is not None:
            found.answer.error(reply.error_code, reply.message)
        elif reply.message:
            found.answer.ok(message=reply.message)
        else:
            found.answer.ok()
