"""`naod learn`."""

import numpy as np
import pytest
from scenes import mask, picture, refuse, run, run_json, write

from naod.perception.colour_model import load_model


@pytest.fixture
def frames(tmp_path):
    return [write(tmp_path / f"f{k}.png", picture(k)) for k in range(3)]


def test_model_from_marked_frames(capfd, tmp_path, frames):
    out = tmp_path / "deep" / "model.toml"
    (line,) = run_json(capfd, "learn", *frames, "--region", "120,95,80,50", "--out", out)
    model = load_model(out)
    assert line["mean"] == pytest.approx(model.mean)
    assert np.allclose(line["covariance"], model.covariance)
    assert line["frames"] == 3
    assert line["pixels"] == 3 * 80 * 50
    assert line["model"] == str(out)
    # (220, 200, 40) in full-range BT.601
    assert model.mean == pytest.approx((187.7, 44.7, 151.0), abs=1.5)


def test_without_json_it_says_where_and_what(capfd, tmp_path, frames):
    out = tmp_path / "model.toml"
    status, lines, err = run(capfd, "learn", frames[0], "--region", "120,95,80,50", "--out", out)
    assert (status, err) == (0, [])
    assert str(out) in lines[0]


def test_a_folder_stands_for_its_pictures(capfd, tmp_path, frames):
    assert len(frames) == 3
    out = tmp_path / "out" / "model.toml"
    (line,) = run_json(capfd, "learn", tmp_path, "--region", "120,95,80,50", "--out", out)
    assert line["frames"] == 3


@pytest.mark.parametrize(
    ("region", "words"),
    [
        ("300,200,40,60", "outside the 320x240 picture"),
        ("0,0,2,2", "at least 16 pixels"),
        ("1,2,3", "four whole numbers"),
        ("1,2,3,x", "four whole numbers"),
        ("1,2,3,4.5", "four whole numbers"),
    ],
)
def test_bad_regions_in_one_line(capfd, tmp_path, frames, region, words):
    out = tmp_path / "model.toml"
    assert words in refuse(capfd, "learn", frames[0], "--region", region, "--out", out)
    assert not out.exists()


def test_a_region_of_one_colour(capfd, tmp_path):
    blank = write(tmp_path / "blank.png", mask())
    line = refuse(
        capfd, "learn", blank, "--region", "120,95,40,40", "--out", tmp_path / "model.toml"
    )
    assert "every pixel is the same" in line


def test_a_smaller_frame_among_them(capfd, tmp_path, frames):
    small = write(tmp_path / "small.png", picture(size=(160, 120), box=(20, 20, 30, 30)))
    words = ("learn", frames[0], small, "--region", "120,95,80,50", "--out", tmp_path / "m.toml")
    assert "160x120" in refuse(capfd, *words)


def test_a_place_that_cannot_be_written(capfd, tmp_path, frames):
    (tmp_path / "file").write_text("")
    out = tmp_path / "file" / "model.toml"
    line = refuse(capfd, "learn", frames[0], "--region", "120,95,80,50", "--out", out)
    assert "cannot write" in line
