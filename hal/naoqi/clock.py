"""The robot's clock against ours: offset and how sure it is.

A value is written into ALMemory, which stamps it with the robot's clock between the moments we send
and hear back. The best of the last round trips, its middle, gives the offset; half of it, and what
the clocks may have drifted since, the uncertainty. On loopback that is about 0.2 ms, over a wire or
wireless network 1 to 10 ms (half of the quickest round trip).

The pictures' stamps are of "the qi clock" (`naoqi_api.yaml`, image_layout). Should that be another
one than ALMemory's, pictures would seem to come from the future or from long ago. Then the quickest
of the pictures tells instead: none is older when it arrives than the time between two pictures,
and none comes before it was taken.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

DRIFT = 100e-6
"""Two quartz clocks differ by no more than this."""
KEPT = 32


@dataclass(frozen=True, slots=True)
class RoundTrip:
    """Our clock before and after, and the robot's in between, in ns."""

    sent_ns: int
    heard_ns: int
    robot_ns: int

    @property
    def offset_ns(self) -> int:
        """The robot's clock minus ours."""
        return self.robot_ns - (self.sent_ns + self.heard_ns) // 2

    def uncertainty_ns(self, now_ns: int) -> int:
        """Half the round trip, and the drift since."""
        half = (self.heard_ns - self.sent_ns) // 2
        return half + round(abs(now_ns - self.heard_ns) * DRIFT)


class MidpointClock:
    """The robot's clock by round trips. Not locked: its owner is."""

    def __init__(self) -> None:
        self._trips: deque[RoundTrip] = deque(maxlen=KEPT)

    def add(self, trip: RoundTrip) -> None:
        """Take one round trip. Raises ValueError if it ends before it begins."""
        if trip.heard_ns < trip.sent_ns:
            raise ValueError(f"a round trip ends before it begins: {trip}")
        self._trips.append(trip)

    def estimate(self, now_ns: int) -> tuple[int, int] | None:
        """Offset (the robot's minus ours) and uncertainty, in ns; None before the first trip."""
        if not self._trips:
            return None
        best = min(self._trips, key=lambda trip: trip.uncertainty_ns(now_ns))
        return best.offset_ns, best.uncertainty_ns(now_ns)

    def forget(self) -> None:
        """The robot has restarted: its clock may be another."""
        self._trips.clear()


class EarliestArrival:
    """The pictures' clock by their arrival alone: the quickest of the last ones."""

    def __init__(self, period_ns: int) -> None:
        self._period_ns = period_ns
        self._least: deque[int] = deque(maxlen=8 * KEPT)

    def add(self, stamp_ns: int, heard_ns: int) -> None:
        """A picture with this stamp arrived at this time of ours."""
        self._least.append(heard_ns - stamp_ns)

    def estimate(self) -> tuple[int, int] | None:
        """As `MidpointClock.estimate`: half a period is taken for the quickest one's age."""
        if not self._least:
            return None
        half = self._period_ns // 2
        return -(min(self._least) - half), half

    def forget(self) -> None:
        """Begin anew."""
        self._least.clear()


OLDEST_NS = 1_000_000_000
"""Older than this no picture arrives."""


def is_plausible(age_ns: int, uncertainty_ns: int) -> bool:
    """Whether a picture can have this age when it arrives: if not, it has another clock."""
    return -uncertainty_ns - 2_000_000 <= age_ns <= OLDEST_NS
