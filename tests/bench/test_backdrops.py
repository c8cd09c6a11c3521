"""The benchmark before photographs, small: a red can before a street and an orange flower."""

import cv2
import numpy as np
import pytest

from naod.bench.backdrops import COLUMNS, backdrop_of, run
from naod.bench.frames import WalkSettings
from naod.bench.motion import smeared
from naod.bench.real import FOLDER_VARIABLE, coloured_photographs
from naod.errors import InputError


@pytest.fixture(autouse=True)
def no_folder(monkeypatch, tmp_path):
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))


@pytest.fixture(scope="module")
def rows():
    pytest.importorskip("sklearn")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(FOLDER_VARIABLE, "nowhere")
        photographs = coloured_photographs()
    assert set(photographs) == {"china", "flower"}
    report = run(lambda told: None, WalkSettings(count=4), photographs)
    return {row[0]: dict(zip(COLUMNS, row, strict=True)) for row in report.rows}


def test_a_can_before_a_flower_of_nearly_its_colour_is_found_sharp(rows):
    row = rows["can, 0 ms"]
    assert row["frames"] == 8
    assert row["found %"] == 100.0
    assert row["lost %"] == 0.0
    assert row["distance % median"] < 1.0


@pytest.mark.parametrize("thing", ["can", "board"])
def test_it_is_found_blurred(rows, thing):
    row = rows[f"{thing}, 33 ms"]
    assert row["lost %"] <= 25.0
    assert row["box IoU"] > 0.7


@pytest.mark.parametrize("name", ["can, 0 ms", "can, 33 ms", "board, 0 ms", "board, 33 ms"])
def test_before_clutter_sigma_is_of_the_size_of_the_errors(rows, name):
    # half of chi squared with three degrees of freedom are below 2.37
    assert 0.4 < rows[name]["error²/sigma² median"] < 7.0


def test_no_photograph_is_taken_for_it(rows):
    assert all(row["found absent %"] == 0.0 for row in rows.values())


def test_without_photographs_it_says_where_they_belong(monkeypatch):
    monkeypatch.setattr("naod.bench.real.importlib.util.find_spec", lambda name: None)
    with pytest.raises(InputError, match=FOLDER_VARIABLE):
        run(lambda told: None, WalkSettings(count=1))


def test_masks_and_grey_pictures_are_no_photographs(tmp_path):
    rng = np.random.default_rng(0)
    grey = np.repeat(rng.integers(0, 256, (300, 400, 1), dtype=np.uint8), 3, axis=2)
    colourful = rng.integers(0, 256, (300, 400, 3), dtype=np.uint8)
    mask = np.zeros((300, 400, 3), np.uint8)
    mask[100:200, 100:200] = (0, 0, 128)
    for name, picture in (("grey", grey), ("mask", mask), ("real", colourful)):
        (tmp_path / name).mkdir()
        cv2.imwrite(str(tmp_path / name / "one.png"), picture)
    assert {"grey", "mask", "real"} & set(coloured_photographs()) == {"real"}


def test_a_backdrop_is_of_the_size_of_the_picture_and_another_part_each_time():
    rng = np.random.default_rng(1)
    backdrop = backdrop_of(rng.integers(0, 256, (90, 200, 3), dtype=np.uint8), (64, 48))
    first, again, second = backdrop(1), backdrop(1), backdrop(2)
    assert first.shape == (48, 64, 3)
    assert first.dtype == np.float32
    assert np.array_equal(first, again)
    assert not np.array_equal(first, second)


def test_smearing_keeps_the_light_and_moves_nothing():
    light = np.zeros((61, 81, 3), np.float32)
    light[30, 40] = 1.0
    out = smeared(light, (9.0, -4.0))
    assert out.sum() == pytest.approx(3.0, rel=1e-4)
    y, x = np.indices(out.shape[:2])
    weights = out[..., 0] / out[..., 0].sum()
    assert (weights * x).sum() == pytest.approx(40.0, abs=0.05)
    assert (weights * y).sum() == pytest.approx(30.0, abs=0.05)
    assert smeared(light, (0.2, 0.1)) is light
