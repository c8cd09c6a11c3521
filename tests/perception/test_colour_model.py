"""Learning a colour: what the mean and the covariance are of, and what is refused."""

import numpy as np
import pytest

from hal.yuyv import yuv_from_yuyv
from naod.errors import InputError
from naod.perception.colour_model import STD_FLOOR, Region, learn, load_model, save_model

REGION = Region(10, 6, 20, 12)


def noisy_frames(count, seed=0, std=(9.0, 6.0, 5.0)):
    rng = np.random.default_rng(seed)
    pixels = rng.normal((120.0, 90.0, 170.0), std, (count, 40, 60, 3))
    return [np.clip(np.rint(frame), 0, 255).astype(np.uint8) for frame in pixels]


def test_mean_and_covariance_are_those_of_all_single_pixels():
    frames = noisy_frames(10)
    inside = np.stack([f[6:18, 10:30] for f in frames]).reshape(-1, 3).astype(float)
    model = learn(frames, REGION)
    assert np.allclose(model.mean, inside.mean(axis=0))
    assert np.allclose(model.covariance, np.cov(inside.T))


def test_averaging_frames_does_not_hide_the_noise_of_one():
    one, ten = learn(noisy_frames(1), REGION), learn(noisy_frames(10), REGION)
    assert np.trace(ten.covariance) > 0.8 * np.trace(one.covariance)


def test_yuyv_frames_give_what_their_yuv_gives():
    rng = np.random.default_rng(3)
    yuyv = rng.integers(60, 200, (40, 60, 2), dtype=np.uint8)
    assert learn([yuyv], REGION) == learn([yuv_from_yuyv(yuyv)], REGION)


def test_a_nearly_flat_colour_has_full_rank():
    frame = np.full((40, 60, 3), (200, 60, 150), np.uint8)
    frame[8, 12] += 1
    model = learn([frame], REGION)
    assert np.linalg.eigvalsh(model.covariance).min() >= STD_FLOOR**2 * (1 - 1e-9)


@pytest.mark.parametrize(
    ("region", "words"),
    [
        (Region(50, 0, 20, 20), "outside the 60x40 picture"),
        (Region(-1, 0, 20, 20), "outside"),
        (Region(0, 30, 20, 20), "outside"),
        (Region(0, 0, 3, 5), "at least 16 pixels"),
        (Region(0, 0, -8, -8), "at least 16 pixels"),
        (Region(0, 0, 0, 50), "at least 16 pixels"),
    ],
)
def test_regions_that_cannot_be_are_refused(region, words):
    with pytest.raises(InputError, match=words):
        learn(noisy_frames(1), region)


def test_a_region_of_one_value_is_refused_with_the_value():
    blank = np.full((40, 60, 3), (255, 128, 128), np.uint8)
    with pytest.raises(InputError, match=r"every pixel is the same, YUV \(255, 128, 128\)"):
        learn([blank, blank], REGION)


def test_no_frame_is_refused():
    with pytest.raises(InputError, match="no frame"):
        learn([], REGION)


def test_a_model_is_read_as_it_was_written(tmp_path):
    model = learn(noisy_frames(2), REGION)
    save_model(tmp_path / "new" / "model.toml", model)
    assert load_model(tmp_path / "new" / "model.toml") == model


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("mean = [1, 2]", "mean"),
        ("mean = [1, 2, 3]", "covariance"),
        ("mean = [1, 2, 3]\ncovariance = [[1, 0, 0], [0, 1, 0], [0, 0, 0]]", "positive definite"),
        ("mean = [1, 2, 3]\ncovariance = [[1, 2, 0], [0, 1, 0], [0, 0, 1]]", "symmetric"),
        ("mean = [nan, 2, 3]\ncovariance = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]", "finite"),
        ("men = [1, 2, 3]", "men"),
    ],
)
def test_broken_models_are_named(tmp_path, text, words):
    path = tmp_path / "model.toml"
    path.write_text(text)
    with pytest.raises(InputError, match=words) as caught:
        load_model(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)
