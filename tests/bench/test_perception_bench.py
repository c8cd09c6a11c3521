"""The benchmark of perception, tiny: every method on rendered pictures with known truth."""

import json
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest

from naod.bench import perception
from naod.bench.contest import MEMCPY
from naod.bench.frames import Walk, WalkSettings
from naod.bench.motion import motion_kernel
from naod.bench.peers import richardson_lucy, wiener
from naod.bench.peers.peer import CONTESTANTS, make_peer
from naod.bench.real import DEFAULT_FOLDER, FOLDER_VARIABLE, real_sequences
from naod.bench.room import Room
from naod.bench.score import main_region, mask_iou, polygon_iou
from naod.bench.table import as_text
from naod.cli.main import main

TINY = WalkSettings(count=2, size=(320, 240), room=Room(walls="plain"))


@pytest.fixture(autouse=True)
def no_photographs(monkeypatch, tmp_path):
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))


@pytest.fixture(scope="module")
def sharp():
    return Walk(TINY).taken("0 ms", 0.0)


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """Of a tiny run, from which one library is missing."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(FOLDER_VARIABLE, str(tmp_path_factory.mktemp("none")))
        patch.setitem(sys.modules, "naod.bench.peers.mixture", None)
        return perception.run(lambda _: None, TINY, walks=1)


@pytest.mark.parametrize("name", CONTESTANTS)
def test_every_peer_covers_a_sharp_can_and_little_else(name, sharp):
    peer = make_peer(name, TINY.size)
    peer.learn(sharp.shown, sharp.region)
    for frame in sharp.frames:
        seen = peer.segment(frame.yuyv, frame.motion_px)
        assert seen.corners_px is not None
        mask = main_region(seen, frame.mask.shape)
        assert mask_iou(mask, frame.mask) > 0.5


def test_the_report_has_a_row_for_everybody_and_memory_is_the_floor(report):
    names = [str(row[0]) for row in report.rows if row[1] is not None]
    assert names == [*(n for n in CONTESTANTS if n != "mixture by EM"), MEMCPY]
    times = {row[0]: row[1] for row in report.rows}
    assert all(times[name] > times[MEMCPY] for name in names[:-1])
    assert all(len(row) == len(report.columns) for row in report.rows)
    assert all(name in as_text(report) for name in names)


def test_further_tables_are_whole_and_in_the_text(report):
    assert [one.name for one in report.further] == [
        "ratios",
        "optima",
        "poses",
        "growth",
        "photographs",
    ]
    for one in report.further:
        assert one.rows or one.name == "photographs"
        assert all(len(row) == len(one.columns) for row in one.rows)
        assert f"\n{one.name}\n" in as_text(report)


def test_every_exact_minimum_is_the_referees(report):
    optima = next(one for one in report.further if one.name == "optima")
    ours = [row for row in optima.rows if str(row[0]).startswith("exact")]
    assert ours
    assert all(row[2] == f"{row[1]} of {row[1]}" for row in ours)


def test_one_json_document_and_a_plot(report, monkeypatch, capsys, tmp_path):
    monkeypatch.setattr(perception, "run", lambda progress: report)
    picture = tmp_path / "bench.png"
    assert main(["bench", "perception", "--json", "--plot", str(picture)]) == 0
    document = json.loads(capsys.readouterr().out)
    assert [bench["name"] for bench in document["benches"]] == ["perception"]
    assert {"name", "columns", "rows", "notes", "further"} <= set(document["benches"][0])
    assert cv2.imread(str(picture)).shape[2] == 3


def test_a_method_whose_library_is_missing_says_so(report):
    assert any("no photographs" in note for note in report.notes)
    row = next(row for row in report.rows if str(row[0]).startswith("mixture by"))
    assert "not installed" in row[0]
    assert row[1] is None


def test_the_referee_finds_the_same_minimum(sharp):
    ours, referee = (
        make_peer(name, TINY.size) for name in ("one Gaussian, exact", "exact by PyMaxflow")
    )
    for peer in (ours, referee):
        peer.learn(sharp.shown, sharp.region)
    yuyv = sharp.frames[0].yuyv
    assert (ours.segment(yuyv).mask == referee.segment(yuyv).mask).all()


@pytest.mark.parametrize("undo", [wiener.undo, richardson_lucy.undo])
@pytest.mark.parametrize("motion", [(6.0, 0.0), (3.0, -4.0)])
def test_a_filter_undoes_most_of_a_known_motion(undo, motion, monkeypatch):
    # without noise they may go all the way
    monkeypatch.setattr(wiener, "NOISE_TO_SIGNAL", 0.001)
    monkeypatch.setattr(richardson_lucy, "ITERATIONS", 80)
    sharp = np.full((60, 80, 3), 60.0, dtype=np.float32)
    sharp[20:40, 30:50] = 200.0
    kernel = motion_kernel(*motion)
    blurred = cv2.filter2D(sharp, -1, kernel, borderType=cv2.BORDER_REFLECT)
    before, after = (((p - sharp) ** 2).mean() for p in (blurred, undo(blurred, kernel)))
    assert after < 0.3 * before


def test_a_motion_kernel_is_as_long_and_as_slanted_as_the_motion():
    kernel = motion_kernel(6.0, -3.0)
    rows, columns = np.indices(kernel.shape) - kernel.shape[0] // 2
    assert kernel.sum() == pytest.approx(1.0)
    # a uniform distribution's variance, length squared over 12, and what bilinear sharing adds
    assert (kernel * columns**2).sum() == pytest.approx(36.0 / 12.0 + 1.0 / 6.0, abs=0.1)
    assert (kernel * columns * rows).sum() == pytest.approx(-18.0 / 12.0, abs=0.1)


def test_photographs_come_with_masks_of_their_size(monkeypatch):
    folder = Path(__file__).parents[2] / DEFAULT_FOLDER
    if not (folder / "lemur").is_dir():
        pytest.skip("the folder of real pictures is not here")
    monkeypatch.setenv(FOLDER_VARIABLE, str(folder))
    sequences = {sequence.name: sequence for sequence in real_sequences()}
    assert len(sequences["drift"].frames) == 16
    for sequence in sequences.values():
        for frame in sequence.frames:
            assert frame.mask.shape == frame.yuyv.shape[:2]
            assert 0.001 < frame.mask.mean() < 0.9


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
