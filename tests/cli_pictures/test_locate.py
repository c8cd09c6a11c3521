"""`naod locate`."""

import cv2
import numpy as np
import pytest
from scenes import BOARD, BOX, CAMERA, mask, picture, refuse, run, run_json, write, write_text

KEYS = ["input", "found", "T_camera_object", "sigma_m", "sigma_rad", "corners_px"]


@pytest.fixture
def files(tmp_path):
    return {
        "picture": write(tmp_path / "a.png", picture(1)),
        "mask": write(tmp_path / "mask" / "a.png", mask()),
        "object": write_text(tmp_path / "board.toml", BOARD),
        "camera": write_text(tmp_path / "camera.toml", CAMERA),
    }


def words(files, **other):
    use = {**files, **other}
    return ("locate", use["picture"], "--mask", use["mask"],
            "--object", use["object"], "--camera", use["camera"])  # fmt: skip


def check_line(line):
    T = np.array(line["T_camera_object"])
    # columns 115 to 204 and rows 90 to 149: the middle is half a pixel right of the centre
    assert T[:3, 3] == pytest.approx((0.0, 0.0, 1.0), abs=0.01)
    assert T[:3, 2] @ (0, 0, -1) > 0.99
    assert T[:3, 1] @ (0, -1, 0) > 0.99
    x, y, w, h = BOX
    left, top, right, bottom = x - 0.5, y - 0.5, x + w - 0.5, y + h - 0.5
    expected = [(left, top), (right, top), (right, bottom), (left, bottom)]
    assert np.abs(np.array(line["corners_px"]) - expected).max() < 0.7
    assert np.array(line["sigma_m"]).shape == (3,)
    assert 0.0 < max(line["sigma_m"]) < 0.05
    assert 0.0 < line["sigma_rad"] < 0.5


def test_from_a_mask(capfd, files):
    (line,) = run_json(capfd, *words(files))
    assert list(line)[:6] == KEYS
    assert line["input"] == files["picture"]
    assert line["found"] is True
    assert line["estimator"] == "exact"
    assert line["ms"] > 0.0
    check_line(line)


def test_from_a_colour_model_and_as_printed(capfd, tmp_path, files):
    model = tmp_path / "model.toml"
    status, _, _ = run(capfd, "learn", files["picture"], "--region", "120,95,80,50", "--out", model)
    assert status == 0
    rest = ("--model", model, "--object", files["object"], "--camera", files["camera"])
    (line,) = run_json(capfd, "locate", files["picture"], *rest)
    check_line(line)
    (printed,) = run_json(capfd, "locate", files["picture"], *rest, "--estimator", "paper")
    assert printed["estimator"] == "paper"
    check_line(printed)


def test_nothing_there(capfd, tmp_path, files):
    empty = write(tmp_path / "empty.png", np.zeros((240, 320), np.uint8))
    (line,) = run_json(capfd, *words(files, mask=empty))
    assert line["found"] is False
    assert line["T_camera_object"] is None
    status, out, _ = run(capfd, *words(files, mask=empty))
    assert status == 0
    assert "not found" in out[0]


def test_masks_of_any_white(capfd, tmp_path, files):
    ones = write(tmp_path / "ones.png", mask() // 255)
    colour = write(tmp_path / "colour.png", cv2.cvtColor(mask(), cv2.COLOR_GRAY2BGR))
    for path in (ones, colour):
        check_line(run_json(capfd, *words(files, mask=path))[0])


def test_folders_of_pictures_and_masks_in_order(capfd, tmp_path, files):
    for k, x in enumerate((60, 115, 170)):
        write(tmp_path / "pictures" / f"{k}.png", picture(k))
        write(tmp_path / "masks" / f"{k}.png", mask(box=(x, 90, 90, 60)))
    lines = run_json(capfd, *words(files, picture=tmp_path / "pictures", mask=tmp_path / "masks"))
    across = [line["T_camera_object"][0][3] for line in lines]
    assert across == pytest.approx([-55 / 300, 0.0, 55 / 300], abs=0.01)


def test_bad_masks_in_one_line(capfd, tmp_path, files):
    small = write(tmp_path / "small.png", mask(size=(160, 120), box=(40, 40, 40, 20)))
    labels = mask() // 255
    labels[0, :9] = 7
    several = write(tmp_path / "several.png", labels)
    assert "160x120" in refuse(capfd, *words(files, mask=small))
    assert "several labels" in refuse(capfd, *words(files, mask=several))
    assert "no such file" in refuse(capfd, *words(files, mask=tmp_path / "none.png"))
    two = write(tmp_path / "b.png", picture(2))
    line = refuse(
        capfd, "locate", files["picture"], two, "--mask", files["mask"],
        "--object", files["object"], "--camera", files["camera"],
    )  # fmt: skip
    assert "2 inputs but 1 masks" in line


@pytest.mark.parametrize(
    ("which", "text", "wanted"),
    [
        ("object", 'kind = "sphere"\nradius_m = 1\n', "sphere"),
        ("object", 'kind = "cylinder"\nradius_m = -1\n', "radius_m"),
        ("object", 'kind = "cylinder"\nradius = 0.03\n', "radius"),
        ("camera", "width = 320\nheight = 240\n", "fx"),
        ("camera", CAMERA.replace("300", "nan"), "fx"),
        ("camera", CAMERA.replace("320", "640"), "320x240"),
        ("camera", CAMERA + "distortion = [1, 2]\n", "distortion"),
    ],
)
def test_bad_descriptions_in_one_line(capfd, tmp_path, files, which, text, wanted):
    path = write_text(tmp_path / "bad.toml", text)
    line = refuse(capfd, *words(files, **{which: path}))
    assert wanted in line
    assert "bad.toml" in line


def test_neither_model_nor_mask(capfd, files):
    status, _, err = run(
        capfd, "locate", files["picture"], "--object", files["object"], "--camera", files["camera"]
    )
    assert status == 2
    assert "--model" in err[-1]
