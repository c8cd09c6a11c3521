import itertools

import numpy as np
import pytest

from naod.perception.unsupervised import UnsupervisedSettings, classes_of

COLOURS = np.array([(150.0, 128, 128), (80, 105, 205), (60, 180, 110), (200, 100, 140)])
SHAPE = (60, 80)


def scene(seed, noise):
    """Nested and neighbouring areas of four colours, with their true classes."""
    truth = np.zeros(SHAPE, dtype=int)
    truth[10:50, 8:34] = 1
    truth[20:36, 16:26] = 2
    truth[30:58, 44:76] = 3
    rng = np.random.default_rng(seed)
    return truth, (COLOURS[truth] + rng.normal(0.0, noise, (*SHAPE, 3))).astype(np.float32)


def wrong(labels, truth):
    """Share of pixels wrong under the best naming of the classes."""
    names = itertools.permutations(range(4))
    return min(np.mean(np.array(name)[labels] != truth) for name in names)


@pytest.mark.parametrize("seed", range(4))
def test_classes_nobody_taught_are_found(seed):
    truth, picture = scene(seed, 14.0)
    found = classes_of(picture, 4)
    assert wrong(found.labels, truth) < 0.01
    means = np.array([model.mean for model in found.models])
    distances = np.linalg.norm(means[:, None] - COLOURS[None], axis=2).min(axis=1)
    assert distances.max() < 3.0


def test_beta_grows_and_it_settles():
    found = classes_of(scene(1, 14.0)[1], 4)
    assert found.betas[0] == 0.0
    assert found.betas[-1] == UnsupervisedSettings().beta
    assert list(found.betas) == sorted(found.betas)
    assert found.changed[-1] < 0.01


def test_neighbours_help_where_colours_overlap():
    truth, picture = scene(2, 30.0)
    alone = classes_of(picture, 4, UnsupervisedSettings(beta=0.0))
    assert wrong(classes_of(picture, 4).labels, truth) < 0.5 * wrong(alone.labels, truth)


def test_the_energy_is_that_of_the_sum():
    picture = scene(3, 14.0)[1]
    found = classes_of(picture, 3)
    total = 0.0
    for i, j in np.ndindex(SHAPE):
        model = found.models[found.labels[i, j]]
        S, offset = np.array(model.covariance), picture[i, j] - model.mean
        total += 0.5 * np.log(np.linalg.det(2 * np.pi * S))
        total += 0.5 * offset @ np.linalg.inv(S) @ offset
        for a, b in ((i + 1, j), (i, j + 1)):
            if a < SHAPE[0] and b < SHAPE[1]:
                total += 2.0 * (found.labels[a, b] != found.labels[i, j])
    assert found.energy == pytest.approx(total, rel=1e-6)


def test_classes_are_named_by_size_and_one_is_the_whole_picture():
    found = classes_of(scene(1, 14.0)[1], 4)
    counts = np.bincount(found.labels.ravel())
    assert (np.diff(counts) <= 0).all()
    assert (classes_of(scene(1, 14.0)[1], 1).labels == 0).all()
    with pytest.raises(ValueError, match="0 classes"):
        classes_of(scene(1, 14.0)[1], 0)
