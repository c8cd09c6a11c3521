"""The benchmark of perception, tiny: every method on rendered pictures with known truth."""

import numpy as np
import pytest

from naod.bench import perception
from naod.bench.frames import Walk, WalkSettings
from naod.bench.peers.peer import PEERS, make_peer
from naod.bench.score import main_region, mask_iou, polygon_iou
from naod.bench.table import as_text
from naod.cli.main import main

TINY = WalkSettings(count=2, size=(320, 240), background="plain")


@pytest.fixture(scope="module")
def sharp():
    return Walk(TINY).taken("0 ms", 0.0)


@pytest.mark.parametrize("name", PEERS)
def test_every_peer_covers_a_sharp_can_and_little_else(name, sharp):
    peer = make_peer(name, TINY.size)
    peer.learn(sharp.shown, sharp.region)
    for frame in sharp.frames:
        seen = peer.segment(frame.yuyv, frame.motion_px)
        assert seen.corners_px is not None
        mask = main_region(seen, frame.mask.shape)
        assert mask_iou(mask, frame.mask) > 0.5


def test_the_report_has_a_row_for_everybody_and_memory_is_the_floor(capsys):
    report = perception.run(lambda _: None, TINY)
    names = [str(row[0]) for row in report.rows]
    assert names == [*PEERS, perception.MEMCPY]
    times = {row[0]: row[1] for row in report.rows}
    assert all(times[name] > times[perception.MEMCPY] for name in PEERS)
    assert all(len(row) == len(report.columns) for row in report.rows)
    assert all(name in as_text(report) for name in names)


def test_an_unknown_benchmark_is_one_line(capsys):
    assert main(["bench", "nonsense"]) == 2
    out, err = capsys.readouterr()
    assert not out
    assert err.count("\n") == 1
    assert "nonsense" in err


def test_overlap_of_quadrilaterals_is_that_of_their_areas():
    square = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])
    assert polygon_iou(square, square + np.array([2.0, 0.0])) == pytest.approx(8.0 / 24.0)
    assert polygon_iou(square, square[::-1]) == pytest.approx(1.0)
    assert polygon_iou(square, square + 10.0) == 0.0
