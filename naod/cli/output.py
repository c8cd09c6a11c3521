"""What commands print: JSON on stdout, progress on stderr when somebody watches."""

from __future__ import annotations

import sys
import time

import msgspec

QUIET_S = 2.0
_PERIOD_S = 0.2


def print_json(document: object) -> None:
    """One JSON document, on one line of stdout."""
    sys.stdout.write(msgspec.json.encode(document).decode() + "\n")
    sys.stdout.flush()


class Progress:
    """A line on the terminal that says what goes on, for work longer than two seconds."""

    def __init__(self, label: str) -> None:
        self._label = label
        self._start = time.monotonic()
        self._next = self._start + QUIET_S
        self._count = 0
        self._shown = False
        self._on = sys.stderr.isatty()

    def label(self, label: str) -> None:
        """Say what is being done from now on."""
        self._label = label
        self.tick()

    def tick(self, detail: str = "") -> None:
        """Something advanced."""
        self._count += 1
        now = time.monotonic()
        if not self._on or now < self._next:
            return
        self._next, self._shown = now + _PERIOD_S, True
        elapsed = now - self._start
        sys.stderr.write(f"\r\x1b[K{self._label}: {self._count} {detail} ({elapsed:.0f} s)")
        sys.stderr.flush()

    def done(self) -> None:
        """Take the line away."""
        if self._shown:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()
