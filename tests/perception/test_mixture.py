import math

import numpy as np
import pytest

from naod.config import SegmentationConfig
from naod.errors import InputError
from naod.perception.blob import find_blob
from naod.perception.colour_model import ColourMixture, Region, learn, load_model, save_model
from naod.perception.energy import STEPS, Singletons
from naod.perception.mixture import energies, fit, learn_mixture, log_density
from naod.perception.segmenter import Segmenter

SIZE = (320, 240)
OBJECT, MARKED = Region(120, 80, 80, 80), Region(130, 90, 60, 60)
WALL = (137, 123, 117)
COLOURS = {
    1: [(80, 105, 205)],
    2: [(80, 105, 205), (230, 128, 128)],
    3: [(60, 180, 110), (230, 128, 90), (120, 60, 150)],
}


def striped(seed, colours):
    """A thing of upright stripes before a wall, YUYV."""
    rng = np.random.default_rng(seed)
    yuv = np.full((SIZE[1], SIZE[0], 3), WALL, dtype=np.float64)
    for x in range(OBJECT.width):
        stripe = x // 10 % len(colours)
        yuv[OBJECT.y : OBJECT.y + OBJECT.height, OBJECT.x + x] = colours[stripe]
    levels = np.clip(np.rint(yuv + rng.normal(0.0, 3.0, yuv.shape)), 0, 255).astype(np.uint8)
    yuyv = np.empty((SIZE[1], SIZE[0], 2), dtype=np.uint8)
    yuyv[..., 0] = levels[..., 0]
    yuyv[:, 0::2, 1], yuyv[:, 1::2, 1] = levels[:, 0::2, 1], levels[:, 0::2, 2]
    return yuyv


@pytest.mark.parametrize("count", [1, 2, 3])
def test_there_are_as_many_components_as_colours(count):
    mixture = learn_mixture([striped(count, COLOURS[count])], MARKED)
    assert len(mixture.components) == count
    means = sorted(one.mean for one in mixture.components)
    assert np.array(means) == pytest.approx(np.array(sorted(COLOURS[count])), abs=1.0)
    assert sum(one.weight for one in mixture.components) == pytest.approx(1.0)


def test_one_component_is_the_gaussian():
    frame = striped(1, COLOURS[1])
    mixture, gaussian = learn_mixture([frame], MARKED), learn([frame], MARKED)
    assert np.array(mixture.components[0].mean) == pytest.approx(np.array(gaussian.mean), abs=0.5)
    colours = np.random.default_rng(2).uniform(0, 255, (1, 50, 3)).astype(np.float32)
    printed = np.empty((1, 50), dtype=np.int32)
    Singletons(gaussian, 16.6, 0.12).differences(colours, printed)
    same = ColourMixture(
        mean=gaussian.mean,
        covariance=gaussian.covariance,
        components=(type(mixture.components[0])(1.0, gaussian.mean, gaussian.covariance),),
    )
    mine = (energies(same, colours.astype(np.float64), 0.12) - 16.6) * STEPS
    assert mine == pytest.approx(printed, rel=1e-3, abs=2.0)


def test_a_fit_has_the_likelihood_that_adding_up_densities_gives():
    rng = np.random.default_rng(4)
    pixels = np.concatenate([rng.normal(m, 8.0, (300, 3)) for m in (60.0, 130.0)])
    components, nats = fit(pixels, 2)
    density = 0.0
    for one in components:
        offsets, S = pixels - one.mean, np.array(one.covariance)
        k = np.einsum("ni,ij,nj->n", offsets, np.linalg.inv(S), offsets)
        density = density + one.weight * np.exp(-k / 2) / math.sqrt(np.linalg.det(2 * np.pi * S))
    assert nats == pytest.approx(np.log(density).mean(), abs=1e-3)
    assert nats >= fit(pixels, 1)[1]


def test_it_finds_the_whole_of_what_one_gaussian_cannot():
    frame = striped(7, COLOURS[3])
    blob = find_blob(
        Segmenter(learn_mixture([frame], MARKED), SegmentationConfig(), SIZE).segment(frame)
    )
    assert blob.area_px == pytest.approx(OBJECT.width * OBJECT.height, rel=0.03)
    plain = find_blob(Segmenter(learn([frame], MARKED), SegmentationConfig(), SIZE).segment(frame))
    assert plain is None or plain.area_px > 2 * OBJECT.width * OBJECT.height


def test_the_file_gives_it_back_and_a_broken_component_is_one_line(tmp_path):
    path = tmp_path / "model.toml"
    mixture = learn_mixture([striped(2, COLOURS[2])], MARKED)
    save_model(path, mixture)
    assert load_model(path) == mixture
    one = mixture.components[0]
    flat = type(one)(one.weight, one.mean, ((0.0, 0.0, 0.0),) * 3)
    save_model(
        path, ColourMixture(mean=mixture.mean, covariance=mixture.covariance, components=(flat,))
    )
    with pytest.raises(InputError, match="positive definite") as error:
        load_model(path)
    assert "\n" not in str(error.value)


def test_energies_are_those_of_the_densities_summed():
    """Against the sum in numpy, where one component rules and where several count."""
    mixture = learn_mixture([striped(5, COLOURS[3])], MARKED)
    colours = np.random.default_rng(4).uniform(0, 255, (20, 300, 3))
    logs = np.stack([log_density(colours, one, 0.12) for one in mixture.components])
    assert energies(mixture, colours, 0.12) == pytest.approx(
        -np.logaddexp.reduce(logs, axis=0), rel=1e-9, abs=1e-9
    )


def test_log_density_is_that_of_a_gaussian():
    """Whitened by a Cholesky factor; determinants from there too."""
    one = learn_mixture([striped(1, COLOURS[1])], MARKED).components[0]
    colours = np.random.default_rng(5).uniform(0, 255, (50, 3))
    root = np.linalg.cholesky(np.array(one.covariance))
    white = np.linalg.solve(root, (colours - np.array(one.mean)).T)
    peak = math.log(one.weight) - 1.5 * math.log(2.0 * math.pi) - np.log(np.diag(root)).sum()
    assert log_density(colours, one) == pytest.approx(peak - 0.5 * (white**2).sum(axis=0))
