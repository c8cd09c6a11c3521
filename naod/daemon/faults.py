"""What is wrong at present, for `state.faults`: short names, each shown for a while."""

from __future__ import annotations

import threading

SHOWN_NS = 5_000_000_000


class Faults:
    """Counts faults by name. Safe to use from any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._last_ns: dict[str, int] = {}
        self.counts: dict[str, int] = {}

    def add(self, name: str, now_ns: int) -> bool:
        """Count a fault; true if it is news, not the same again and again."""
        with self._lock:
            last_ns = self._last_ns.get(name)
            self._last_ns[name] = now_ns
            self.counts[name] = self.counts.get(name, 0) + 1
        return last_ns is None or now_ns - last_ns > SHOWN_NS

    def present(self, now_ns: int) -> tuple[str, ...]:
        """The faults of the last seconds."""
        with self._lock:
            return tuple(sorted(n for n, at in self._last_ns.items() if now_ns - at <= SHOWN_NS))
