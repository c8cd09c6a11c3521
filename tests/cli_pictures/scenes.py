"""Little pictures and files the commands are run on."""

import json

import cv2
import numpy as np

from naod.cli.main import main

CAMERA = "width = 320\nheight = 240\nfx = 300\nfy = 300\ncx = 159.5\ncy = 119.5\n"
BOARD = 'kind = "rectangle"\nwidth_m = 0.30\nheight_m = 0.20\n'
# at 1 m a board of 0.30 x 0.20 m covers 90 x 60 pixels
BOX = (115, 90, 90, 60)


def picture(seed=0, size=(320, 240), box=BOX, colour=(40, 200, 220)):
    """BGR noise about grey with a coloured box."""
    rng = np.random.default_rng(seed)
    image = np.full((size[1], size[0], 3), (140, 150, 150), float)
    x, y, w, h = box
    image[y : y + h, x : x + w] = colour
    return np.clip(image + rng.normal(0, 3, image.shape), 0, 255).astype(np.uint8)


def mask(size=(320, 240), box=BOX):
    image = np.zeros((size[1], size[0]), np.uint8)
    x, y, w, h = box
    image[y : y + h, x : x + w] = 255
    return image


def write(path, image):
    path.parent.mkdir(parents=True, exist_ok=True)
    assert cv2.imwrite(str(path), image)
    return str(path)


def write_text(path, text):
    path.write_text(text)
    return str(path)


def run(capfd, *words):
    """Exit status, lines of stdout, lines of stderr."""
    try:
        status = main([str(word) for word in words])
    except SystemExit as stop:
        status = stop.code
    out, err = capfd.readouterr()
    return status, out.splitlines(), err.splitlines()


def run_json(capfd, *words):
    """The JSON documents printed by a command that must succeed, one a line."""
    status, out, err = run(capfd, *words, "--json")
    assert status == 0, err
    return [json.loads(line) for line in out]


def refuse(capfd, *words):
    """The one line of a command that must refuse its input."""
    status, out, err = run(capfd, *words)
    assert status == 2, (out, err)
    assert len(err) == 1, err
    assert "Traceback" not in err[0]
    return err[0]
