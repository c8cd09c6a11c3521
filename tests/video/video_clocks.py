"""Clocks for cameras: the machine's, and one that only moves when somebody waits."""

import time


class MachineClock:
    def now_ns(self):
        return time.monotonic_ns()

    def sleep_until(self, deadline_ns):
        time.sleep(max(0, deadline_ns - time.monotonic_ns()) / 1e9)


class VirtualClock:
    def __init__(self, now_ns=5_000_000_000):
        self.now = now_ns

    def now_ns(self):
        return self.now

    def sleep_until(self, deadline_ns):
        self.now = max(self.now, deadline_ns)
