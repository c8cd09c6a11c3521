"""Shared memory: whole records or none, whoever writes while we read; the past interpolated."""

from __future__ import annotations

import os
import subprocess
import sys

import msgspec
import numpy as np
import pytest

from hal.between import state_between
from hal.errors import BackendError
from hal.lola.shared import LolaStatus, Shared, create


def values_of(number: float) -> np.ndarray:
    return np.full(44, number)


def test_nothing_before_the_first_and_the_newest_after() -> None:
    shared, fd = create(8)
    assert shared.newest() is None
    assert shared.around(5) is None
    shared.put(100, 101, values_of(1.0))
    shared.put(200, 203, values_of(2.0))
    newest = Shared(fd).newest()
    assert newest is not None
    assert newest.stamp_ns == 200
    assert (newest.angles_rad == 2.0).all()
    answered = shared.answer(1)
    assert answered is not None
    assert (answered[0].stamp_ns, answered[1]) == (200, 203)
    os.close(fd)


@pytest.mark.parametrize("count", [3, 8, 9, 21])
def test_past_is_interpolated_and_ends_where_the_ring_does(count: int) -> None:
    shared, fd = create(8)
    os.close(fd)
    stamps = 1000 + 12 * np.arange(count) + np.arange(count) % 3
    for number, stamp in enumerate(stamps):
        shared.put(int(stamp), 0, values_of(float(number**2)))
    kept = stamps[-min(count, 7) :]
    for stamp in range(int(kept[0]), int(kept[-1]) + 1):
        found = shared.around(stamp)
        assert found is not None
        body = state_between(*found, stamp)
        expected = np.interp(stamp, stamps, np.arange(count) ** 2.0)
        assert body.angles_rad == pytest.approx(np.full(26, expected))
        assert body.temperature_max_c == pytest.approx(expected)
    assert shared.around(int(stamps[-1]) + 1) is None
    assert shared.around(int(stamps[0]) - 1) is None
    if count > 8:
        assert shared.around(int(stamps[0])) is None, "forgotten"


def test_status_comes_back_as_it_was_told() -> None:
    shared, fd = create(4)
    os.close(fd)
    status = LolaStatus(
        5, True, False, mode="hold", refusal="because", hot=("LKneePitch",), ticks=9
    )
    shared.tell(status)
    assert shared.status() == status
    longer = msgspec.structs.replace(status, refusal="b" * 300)
    shared.tell(longer)
    shared.tell(status)
    assert shared.status() == status


WRITER = """
import sys
import numpy as np
from hal.lola.shared import LolaStatus, Shared
shared = Shared(int(sys.argv[1]))
for number in range(30000):
    shared.put(number + 1, number, np.full(44, float(number + 1)))
    if number % 10 == 0:
        text = str(number) * (1 + number % 5)
        shared.tell(LolaStatus(number, True, True, refusal=text, trouble=text))
"""


def test_reader_never_sees_half_of_a_record_of_another_process() -> None:
    shared, fd = create(4)
    writer = subprocess.Popen([sys.executable, "-c", WRITER, str(fd)], pass_fds=[fd])
    shared.tell(LolaStatus(0, True, True, refusal="", trouble=""))
    looks = 0
    while writer.poll() is None or shared.count < 30000:
        newest = shared.newest()
        if newest is not None:
            assert (newest.angles_rad == float(newest.stamp_ns)).all()
            assert newest.battery == newest.temperature_max_c == float(newest.stamp_ns)
            looks += 1
        status = shared.status()
        assert status.refusal == status.trouble
        assert writer.poll() in (None, 0)
    os.close(fd)
    assert looks > 100


def test_foreign_memory_is_refused() -> None:
    fd = os.memfd_create("other")
    os.ftruncate(fd, 100)
    with pytest.raises(BackendError, match="none of ours"):
        Shared(fd)
    os.close(fd)
