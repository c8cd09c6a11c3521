"""`naod segment`."""

import cv2
import numpy as np
import pytest
from scenes import BOX, mask, picture, refuse, run, run_json, write, write_text

from hal.yuyv import yuyv_from_rgb
from naod.config import SegmentationConfig
from naod.finding.find import likeliest
from naod.finding.hue import Colours
from naod.perception.colour_model import load_model
from naod.perception.segmenter import Segmenter


@pytest.fixture
def model(capfd, tmp_path):
    marked = write(tmp_path / "model" / "marked.png", picture(9))
    path = tmp_path / "model.toml"
    assert run(capfd, "learn", marked, "--region", "120,95,80,50", "--out", path)[0] == 0
    return path


def overlap(a, b):
    return np.logical_and(a, b).sum() / np.logical_or(a, b).sum()


def test_masks_and_lines(capfd, tmp_path, model):
    inputs = [
        write(tmp_path / "a.png", picture(1)),
        write(tmp_path / "b.bmp", picture(2, box=(10, 10, 60, 40))),
        write(tmp_path / "c.png", picture(3, box=(0, 0, 0, 0))),
    ]
    out = tmp_path / "masks"
    lines = run_json(capfd, "segment", *inputs, "--model", model, "--out", out)
    assert [line["input"] for line in lines] == inputs
    assert [line["found"] for line in lines] == [True, True, False]
    for line, box in zip(lines[:2], (BOX, (10, 10, 60, 40)), strict=True):
        promised = ["input", "found", "pixels", "energy", "iterations", "ms"]
        assert list(line) == [*promised, "probability"]
        assert line["probability"] > 0.5
        stem = line["input"].rsplit("/", 1)[1][:1]
        image = cv2.imread(str(out / f"{stem}.png"), cv2.IMREAD_UNCHANGED)
        assert set(np.unique(image)) == {0, 255}
        assert overlap(image > 0, mask(box=box) > 0) > 0.97
        assert line["pixels"] == (image > 0).sum()
        assert isinstance(line["iterations"], int)
        assert line["ms"] > 0.0
    assert lines[2]["pixels"] == 0
    assert lines[2]["probability"] == 0.0
    assert (out / "c.png").exists()


def test_the_probability_is_the_daemons(capfd, tmp_path, model):
    image = picture(6, colour=(70, 185, 195))
    (line,) = run_json(capfd, "segment", write(tmp_path / "a.png", image), "--model", model)
    learnt, settings = load_model(model), SegmentationConfig()
    yuyv = yuyv_from_rgb(image[..., ::-1])
    segmentation = Segmenter(learnt, settings, (320, 240)).segment(yuyv)
    here = (segmentation, None, None, None, settings.pixels_min)
    seen = likeliest(*here, colours=Colours(yuyv, learnt)).probability
    assert line["probability"] == pytest.approx(seen, abs=1e-4)
    assert abs(likeliest(*here).probability - seen) > 1e-3


def test_an_odd_size_and_a_grey_picture(capfd, tmp_path, model):
    odd = write(tmp_path / "odd.png", picture(4, size=(321, 243)))
    grey = write(tmp_path / "grey.png", picture(5)[..., 0])
    out = tmp_path / "masks"
    lines = run_json(capfd, "segment", odd, grey, "--model", model, "--out", out)
    assert [line["found"] for line in lines] == [True, False]
    assert cv2.imread(str(out / "odd.png"), 0).shape == (243, 321)


def test_tiny_pictures(capfd, tmp_path, model):
    one = write(tmp_path / "one.png", picture(4, size=(1, 1), box=(0, 0, 1, 1)))
    row = write(tmp_path / "row.png", picture(4, size=(37, 1), box=(3, 0, 30, 1)))
    lines = run_json(capfd, "segment", one, row, "--model", model, "--out", tmp_path / "m")
    assert [line["found"] for line in lines] == [False, True]


def test_a_video_by_frames(capfd, tmp_path, model):
    path = tmp_path / "clip.avi"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"MJPG"), 10.0, (320, 240))
    if not writer.isOpened():
        pytest.skip("this OpenCV writes no MJPG")
    for k in range(3):
        writer.write(picture(k))
    writer.release()
    out = tmp_path / "masks"
    lines = run_json(capfd, "segment", path, "--model", model, "--out", out)
    assert sorted(p.name for p in out.iterdir()) == [f"clip_{k:06d}.png" for k in range(3)]
    assert [line["input"].rsplit("/", 1)[1] for line in lines] == [
        f"clip_{k:06d}" for k in range(3)
    ]
    assert all(line["found"] for line in lines)


def test_without_json_a_line_each_for_people(capfd, tmp_path, model):
    path = write(tmp_path / "a.png", picture(1))
    status, out, err = run(capfd, "segment", path, "--model", model)
    assert (status, err, len(out)) == (0, [], 1)
    assert out[0].startswith(f"{path}: found")


def truncated(path, image, share=0.5):
    write(path, image)
    data = path.read_bytes()
    path.write_bytes(data[: int(len(data) * share)])
    return str(path)


def test_bad_pictures_in_one_line(capfd, tmp_path, model):
    cases = {
        str(tmp_path / "none.png"): "no such file",
        write_text(tmp_path / "words.png", "not a picture"): "cannot be read as a picture",
        write_text(tmp_path / "empty.jpg", ""): "is empty",
        truncated(tmp_path / "half.png", picture()): "cannot be read as a picture",
        truncated(tmp_path / "half.jpg", picture()): "cannot be read as a picture",
        write_text(tmp_path / "words.mp4", "not a video"): "cannot be read as a video",
    }
    for path, words in cases.items():
        line = refuse(capfd, "segment", path, "--model", model)
        assert words in line
        assert path in line


def test_an_empty_folder_and_two_of_one_name(capfd, tmp_path, model):
    (tmp_path / "empty").mkdir()
    assert "no pictures" in refuse(capfd, "segment", tmp_path / "empty", "--model", model)
    one, other = (write(tmp_path / d / "a.png", picture()) for d in ("x", "y"))
    assert "same name" in refuse(capfd, "segment", one, other, "--model", model)


def test_a_mask_never_replaces_its_picture(capfd, tmp_path, model):
    path = write(tmp_path / "a.png", picture())
    before = (tmp_path / "a.png").read_bytes()
    words = ("segment", path, "--model", model, "--out", tmp_path)
    assert "would replace it" in refuse(capfd, *words)
    assert (tmp_path / "a.png").read_bytes() == before


def test_bad_models_in_one_line(capfd, tmp_path):
    path = write(tmp_path / "a.png", picture())
    assert "no such file" in refuse(capfd, "segment", path, "--model", tmp_path / "none.toml")
    wrong = write_text(tmp_path / "wrong.toml", "mean = [1, 2, 3]\nspread = 4\n")
    line = refuse(capfd, "segment", path, "--model", wrong)
    assert wrong in line
    assert "spread" in line or "covariance" in line
    assert "not valid TOML" in refuse(
        capfd, "segment", path, "--model", write_text(tmp_path / "no.toml", "mean = [")
    )


def test_no_input_at_all(capfd, tmp_path, model):
    status, _, err = run(capfd, "segment", "--model", model)
    assert status == 2
    assert "INPUT" in err[-1]
