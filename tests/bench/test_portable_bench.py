"""The benchmark of portable kernels, tiny: both processes with the same ones."""

import os
from contextlib import closing

import pytest

from naod.bench.frames import WalkSettings
from naod.bench.portable import COLUMNS, Timer, run
from naod.bench.ratios import BOX, OBJECT, POSE
from naod.bench.room import Room
from naod.errors import NaodError

TINY = WalkSettings(count=2, size=(320, 240), room=Room(walls="plain"))


def test_every_work_is_timed_in_both_processes():
    report = run(lambda _: None, TINY, rounds=2, portable=os.environ)
    assert report.columns == COLUMNS
    assert [row[0] for row in report.rows] == [BOX, OBJECT, POSE]
    for _, here, there, ratio in report.rows:
        assert here > 0.0
        assert there > 0.0
        assert ratio > 0.0


def test_a_process_that_ended_is_named():
    nowhere = {"PATH": os.defpath, "PYTHONPATH": "", "PYTHONHOME": "/nowhere"}
    with (
        closing(Timer("of nobody", TINY, nowhere)) as timer,
        pytest.raises(NaodError, match="of nobody has ended"),
    ):
        timer.medians()
