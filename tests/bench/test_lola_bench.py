"""The measurement behind `naod bench lola`: every message is accounted for."""

from __future__ import annotations

import numpy as np
import pytest

from hal.backends import time_loop
from hal.errors import BackendError
from hal.timing import LoopTiming


def test_late_and_missing_answers_are_missed() -> None:
    delays = np.array([0.001, 0.0119, 0.0121, np.inf, 0.012])
    assert LoopTiming(delays, 0.012, False).missed == 2


@pytest.mark.parametrize("in_process", [False, True])
def test_every_message_is_answered_or_missed(in_process: bool) -> None:
    timing = time_loop("lola", 0.6, in_process=in_process, real_time=False)
    assert timing.answered_s.shape == (50,)
    assert (timing.answered_s > 0.0).all()
    assert not timing.real_time
    # a process that nobody loads is on time but for what the machine does beside it
    assert np.isfinite(timing.answered_s).mean() > 0.5
    assert np.median(timing.answered_s) < 0.012


def test_backend_without_a_loop_of_its_own_is_refused() -> None:
    with pytest.raises(BackendError, match="there is no backend 'sim'"):
        time_loop("sim", 1.0, in_process=False, real_time=False)
