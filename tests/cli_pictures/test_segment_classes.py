"""`naod segment --unsupervised N`."""

import json
import subprocess
import sys

import cv2
import numpy as np


def naod(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "naod", *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def test_a_picture_falls_into_its_colours(tmp_path):
    picture = np.full((240, 321, 3), (120, 160, 90), dtype=np.uint8)
    picture[60:180, 80:200] = (30, 20, 200)
    noise = np.random.default_rng(3).normal(0.0, 4.0, picture.shape)
    picture = np.clip(picture + noise, 0, 255).astype(np.uint8)
    cv2.imwrite(str(tmp_path / "thing.png"), picture)
    out = tmp_path / "out"
    done = naod("segment", tmp_path / "thing.png", "--unsupervised", 2, "--out", out, "--json")
    assert done.returncode == 0, done.stderr
    line = json.loads(done.stdout)
    assert line["found"]
    assert len(line["classes"]) == 2
    mask = cv2.imread(str(out / "thing.png"), cv2.IMREAD_GRAYSCALE)
    truth = np.zeros((240, 321), dtype=bool)
    truth[60:180, 80:200] = True
    assert mask.shape == truth.shape
    assert np.mean((mask == 255) != truth) < 0.01


def test_no_classes_or_both_ways_is_one_line(tmp_path):
    for arguments in (("--unsupervised", 0), ("--unsupervised", 2, "--model", "m.toml"), ()):
        done = naod("segment", tmp_path, *arguments)
        assert done.returncode == 2
        assert "Traceback" not in done.stderr
