"""A clock that only moves when somebody waits."""


class VirtualClock:
    def __init__(self, now_ns=5_000_000_000):
        self.now = now_ns

    def now_ns(self):
        return self.now

    def sleep_until(self, deadline_ns):
        self.now = max(self.now, deadline_ns)
