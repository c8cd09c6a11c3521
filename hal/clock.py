"""The machine's monotonic clock, which every process on it shares."""

from __future__ import annotations

import time


class MonotonicClock:
    """`hal.protocols.Clock` for real robots."""

    def now_ns(self) -> int:
        """CLOCK_MONOTONIC in ns."""
        return time.monotonic_ns()

    def sleep_until(self, deadline_ns: int) -> None:
        """Return once `now_ns` has reached the deadline."""
        while (left := deadline_ns - time.monotonic_ns()) > 0:
            time.sleep(left / 1e9)
