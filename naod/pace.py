"""Absolute deadlines of a periodic task: lateness never adds up, nothing missed is made up for."""

from __future__ import annotations


class Pace:
    """The next deadline on a fixed grid of times, nanoseconds of one clock."""

    def __init__(self, start_ns: int, period_ns: int) -> None:
        self.period_ns = period_ns
        self.deadline_ns = start_ns + period_ns
        self.overruns = 0

    def advance(self, now_ns: int) -> int:
        """Move to the first deadline after now; returns how many were missed."""
        due = max(0, (now_ns - self.deadline_ns) // self.period_ns + 1)
        self.deadline_ns += due * self.period_ns
        missed = max(0, due - 1)
        self.overruns += missed
        return missed

    def left_s(self, now_ns: int) -> float:
        """Seconds until the deadline, at least 0."""
        return max(0, self.deadline_ns - now_ns) / 1e9
