"""A bounded past of stamped values, oldest forgotten first."""

from __future__ import annotations

from bisect import bisect_right
from typing import Generic, TypeVar

T = TypeVar("T")


class History(Generic[T]):
    """Values in the order of their stamps. Not locked: its owner is."""

    def __init__(self, capacity: int) -> None:
        self._capacity = capacity
        self._stamps: list[int] = []
        self._values: list[T] = []

    def append(self, stamp_ns: int, value: T) -> None:
        """Add a value; its stamp must be later than all before."""
        if self._stamps and stamp_ns <= self._stamps[-1]:
            raise ValueError(f"stamp {stamp_ns} is not after {self._stamps[-1]}")
        self._stamps.append(stamp_ns)
        self._values.append(value)
        if len(self._stamps) > 2 * self._capacity:
            del self._stamps[: -self._capacity]
            del self._values[: -self._capacity]

    def clear(self) -> None:
        """Forget everything."""
        self._stamps.clear()
        self._values.clear()

    @property
    def newest_ns(self) -> int:
        """Stamp of the newest value; raises IndexError if there is none."""
        return self._stamps[-1]

    def newest_until(self, stamp_ns: int) -> tuple[int, T] | None:
        """The newest value not later than a stamp."""
        index = bisect_right(self._stamps, stamp_ns) - 1
        return (self._stamps[index], self._values[index]) if index >= 0 else None

    def around(self, stamp_ns: int) -> tuple[T, T, float] | None:
        """The values before and after a stamp and how far it is between them, 0 to 1.

        None outside the recorded past.
        """
        index = bisect_right(self._stamps, stamp_ns) - 1
        if index < 0 or (index + 1 == len(self._stamps) and stamp_ns > self._stamps[-1]):
            return None
        if index + 1 == len(self._stamps):
            return self._values[index], self._values[index], 0.0
        span = self._stamps[index + 1] - self._stamps[index]
        share = (stamp_ns - self._stamps[index]) / span
        return self._values[index], self._values[index + 1], share
