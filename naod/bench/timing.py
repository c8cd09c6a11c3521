"""Timing that survives a noisy machine: contestants take turns, medians and ratios are reported."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Mapping

import msgspec


class Timing(msgspec.Struct, frozen=True):
    """One contestant: median time, and that over the reference's."""

    name: str
    median_ms: float
    ratio: float


def interleaved(
    contestants: Mapping[str, Callable[[int], object]],
    reference: str,
    rounds: int,
    warm_up: int = 2,
) -> list[Timing]:
    """Let each contestant do round 0, then each round 1, and so on.

    A contestant is called with the round's number and times as one unit of work. `reference` names
    the one whose median the ratios are over.
    """
    seconds: dict[str, list[float]] = {name: [] for name in contestants}
    for number in range(-warm_up, rounds):
        for name, work in contestants.items():
            start = time.perf_counter()
            work(max(number, 0))
            took = time.perf_counter() - start
            if number >= 0:
                seconds[name].append(took)
    medians = {name: statistics.median(times) for name, times in seconds.items()}
    base = medians[reference]
    return [Timing(name, 1e3 * value, value / base) for name, value in medians.items()]
