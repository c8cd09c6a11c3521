"""How well the loop keeps time, for `diagnostics`."""

from __future__ import annotations

import os
import statistics
from pathlib import Path

from naod.messages import DiagnosticsMessage

REPORT_NS = 1_000_000_000
_PAGE_BYTES = os.sysconf("SC_PAGE_SIZE")


class Gauges:
    """Gathers ticks for a second, then sums them up."""

    def __init__(self, start_ns: int) -> None:
        self.frames = 0
        self._since_ns = start_ns
        self._last_ns: int | None = None
        self._periods_ms: list[float] = []
        self._latencies_ms: list[float] = []

    def tick(self, begun_ns: int) -> None:
        """A tick began."""
        if self._last_ns is not None:
            self._periods_ms.append((begun_ns - self._last_ns) / 1e6)
        self._last_ns = begun_ns

    def frame(self, stamp_ns: int, done_ns: int) -> None:
        """A frame has been turned into commands."""
        self.frames += 1
        self._latencies_ms.append((done_ns - stamp_ns) / 1e6)

    def due(self, now_ns: int) -> bool:
        """Whether a second has passed."""
        return now_ns - self._since_ns >= REPORT_NS

    def report(
        self,
        now_ns: int,
        overruns: int,
        refused: int,
        temperature_max_c: float,
        battery: float,
        blur_px: float | None = None,
    ) -> DiagnosticsMessage:
        """Sum up and begin the next second."""
        periods, latencies = self._periods_ms or [0.0], self._latencies_ms or [0.0]
        message = DiagnosticsMessage(
            stamp_ns=now_ns,
            period_ms=statistics.fmean(periods),
            period_max_ms=max(periods),
            jitter_ms=statistics.pstdev(periods),
            latency_ms=statistics.fmean(latencies),
            overruns=overruns,
            frames=self.frames,
            refused=refused,
            memory_mb=memory_mb(),
            temperature_max_c=temperature_max_c,
            battery=battery,
            blur_px=blur_px,
        )
        self._since_ns = now_ns
        self._periods_ms, self._latencies_ms = [], []
        return message


def memory_mb() -> float:
    """Resident memory of this process, 10^6 bytes."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * _PAGE_BYTES / 1e6
