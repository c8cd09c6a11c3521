"""The robot's clock from round trips: never wrong by more than it says."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hal.naoqi.clock import (
    DRIFT,
    EarliestArrival,
    MidpointClock,
    RoundTrip,
    is_plausible,
)

MS = 1_000_000
delays = st.integers(0, 50 * MS)


@given(st.integers(-(10**15), 10**15), st.lists(st.tuples(delays, delays), min_size=1, max_size=50))
def test_offset_is_within_its_uncertainty_whatever_the_ways_take(offset, ways):
    clock = MidpointClock()
    now = 10**12
    for there, back in ways:
        clock.add(RoundTrip(now, now + there + back, now + there + offset))
        now += 1000 * MS
    found, uncertainty = clock.estimate(now)
    assert abs(found - offset) <= uncertainty + 1
    quickest = min(there + back for there, back in ways[-32:])
    assert uncertainty <= quickest // 2 + 1 + DRIFT * 33_000 * MS


@given(st.floats(-0.9 * DRIFT, 0.9 * DRIFT))
def test_clocks_that_drift_stay_within_the_uncertainty(drift):
    clock = MidpointClock()
    for second in range(100):
        now = second * 1000 * MS
        clock.add(RoundTrip(now, now + 2 * MS, round((now + MS) * (1.0 + drift))))
    now = 100_000 * MS
    found, uncertainty = clock.estimate(now)
    assert abs(found - drift * now) <= uncertainty + 1


def test_best_trip_wins():
    clock = MidpointClock()
    clock.add(RoundTrip(0, 10 * MS, 9 * MS))
    clock.add(RoundTrip(20 * MS, 21 * MS, 20 * MS + MS // 2))
    clock.add(RoundTrip(40 * MS, 60 * MS, 41 * MS))
    assert clock.estimate(60 * MS) == (0, MS // 2 + 3900)


def test_unknown_before_the_first_and_after_a_restart():
    clock = MidpointClock()
    assert clock.estimate(0) is None
    clock.add(RoundTrip(0, 2, 1))
    assert clock.estimate(2) is not None
    clock.forget()
    assert clock.estimate(2) is None
    with pytest.raises(ValueError, match="before it begins"):
        clock.add(RoundTrip(2, 1, 1))


@given(st.integers(-(10**15), 10**15), st.lists(st.integers(0, 200), min_size=1, max_size=100))
def test_arrival_alone_is_right_to_half_a_period_if_one_was_quick(offset, late_ms):
    """The quickest is between 0 and a period old."""
    clock = EarliestArrival(66 * MS)
    for n, late in enumerate([*late_ms, 20]):
        taken = n * 66 * MS
        clock.add(taken + offset, taken + late * MS)
    found, uncertainty = clock.estimate()
    quickest = min(*late_ms, 20) * MS
    assert found == offset - quickest + 33 * MS
    assert abs(found - offset) <= uncertainty


def test_pictures_of_another_clock_are_noticed():
    assert is_plausible(30 * MS, MS)
    assert is_plausible(-2 * MS, MS)
    assert not is_plausible(-5 * MS, MS)
    assert not is_plausible(3000 * MS, MS)
