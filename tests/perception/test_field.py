"""Reduction, energy and its descent, against brute force and plain formulas."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hal.yuyv import yuv_from_yuyv
from naod.config import SegmentationConfig
from naod.perception.colour_model import ColourModel
from naod.perception.energy import STEPS, Singletons, field_energy
from naod.perception.icm import descend, label_by_singletons
from naod.perception.reduction import Reduction
from naod.perception.segmenter import Segmenter

MODEL = ColourModel(
    mean=(100.0, 90.0, 180.0),
    covariance=((60.0, 5.0, -8.0), (5.0, 30.0, 4.0), (-8.0, 4.0, 40.0)),
)


@pytest.mark.parametrize(
    ("size", "most"), [((640, 480), 160), ((62, 35), 20), ((854, 480), 160), ((8, 6), 160)]
)
def test_reduction_is_the_mean_over_blocks(size, most):
    width, height = size
    yuyv = np.random.default_rng(0).integers(0, 256, (height, width, 2), dtype=np.uint8)
    reduction = Reduction(size, most)
    small, block = reduction(yuyv), reduction.block
    yuv = yuv_from_yuyv(yuyv).astype(float)
    assert small.shape[1] <= most
    for i, j in itertools.product(range(small.shape[0]), range(small.shape[1])):
        part = yuv[i * block : (i + 1) * block, j * block : (j + 1) * block]
        assert np.allclose(small[i, j], part.mean(axis=(0, 1)), atol=1e-3)


def test_a_picture_of_another_size_is_refused():
    with pytest.raises(ValueError, match="640x480"):
        Reduction((640, 480), 160)(np.zeros((480, 320, 2), np.uint8))


def test_singletons_are_minus_log_density_against_the_background():
    rng = np.random.default_rng(1)
    colours = rng.uniform(0.0, 255.0, (5, 7, 3))
    out = np.empty((5, 7), np.int32)
    Singletons(MODEL, 16.6).differences(colours.astype(np.float32), out)
    covariance = np.array(MODEL.covariance)
    gap = colours - np.array(MODEL.mean)
    k = np.einsum("ijc,cd,ijd->ij", gap, np.linalg.inv(covariance), gap)
    expected = 0.5 * (np.log((2 * np.pi) ** 3 * np.linalg.det(covariance)) + k) - 16.6
    assert np.abs(out / STEPS - np.minimum(expected, (1 << 20) / STEPS)).max() < 0.01


def test_light_widens_along_the_shades_of_one_surface_only():
    mean = np.array(MODEL.mean) - (0.0, 128.0, 128.0)
    darker = 0.7 * mean + (0.0, 128.0, 128.0)
    beside = np.array(MODEL.mean) + np.cross(mean, (0.0, 0.0, 1.0)) / np.linalg.norm(mean) * 40.0
    colours = np.array([[darker, beside]], dtype=np.float32)
    narrow, wide = np.empty((1, 2), np.int32), np.empty((1, 2), np.int32)
    Singletons(MODEL, 16.6).differences(colours, narrow)
    Singletons(MODEL, 16.6, 0.12).differences(colours, wide)
    assert narrow[0, 0] > 0 > wide[0, 0]
    assert wide[0, 1] > 0


def energy_of(differences, labels, beta):
    """Equation 3 above the all-background field, spelt out."""
    total = int(differences[labels == 1].sum())
    total += beta * int((labels[1:] != labels[:-1]).sum())
    return total + beta * int((labels[:, 1:] != labels[:, :-1]).sum())


def settle(differences, beta):
    labels = np.empty(differences.shape, np.uint8)
    energies = np.zeros(60, np.int64)
    label_by_singletons(differences, labels)
    sweeps = descend(differences, labels, beta, 1, energies)
    return labels, energies[: sweeps + 1]


def least_energy(differences, beta):
    cells = differences.size
    shape = differences.shape
    return min(
        energy_of(differences, np.array(bits, np.uint8).reshape(shape), beta)
        for bits in itertools.product((0, 1), repeat=cells)
    )


fields = st.integers(1, 6).flatmap(
    lambda w: st.lists(
        st.lists(st.integers(-900, 900), min_size=w, max_size=w), min_size=1, max_size=6
    )
)


@settings(max_examples=200, derandomize=True, deadline=None)
@given(rows=fields, beta=st.integers(0, 600))
def test_the_energy_never_rises_and_no_single_flip_lowers_it_in_the_end(rows, beta):
    differences = np.array(rows, np.int32)
    labels, energies = settle(differences, beta)
    assert (np.diff(energies) <= 0).all()
    assert energies[-1] == energy_of(differences, labels, beta)
    assert energies[-1] == field_energy(differences, labels, beta)
    for i, j in itertools.product(range(labels.shape[0]), range(labels.shape[1])):
        flipped = labels.copy()
        flipped[i, j] ^= 1
        assert energy_of(differences, flipped, beta) >= energies[-1]


def test_it_is_never_below_the_brute_force_minimum_and_mostly_on_it():
    rng = np.random.default_rng(2)
    reached = []
    for _ in range(25):
        differences = rng.integers(-500, 500, (3, 4)).astype(np.int32)
        least = least_energy(differences, 60)
        final = settle(differences, 60)[1][-1]
        assert final >= least
        reached.append(final == least)
    assert np.mean(reached) > 0.7


def test_it_is_the_brute_force_minimum_where_singletons_outweigh_all_neighbours():
    rng = np.random.default_rng(3)
    for _ in range(10):
        differences = (rng.choice([-1, 1], (3, 4)) * rng.integers(401, 900, (3, 4))).astype(
            np.int32
        )
        assert settle(differences, 100)[1][-1] == least_energy(differences, 100)


def test_a_lonely_speck_goes_and_a_hole_closes():
    differences = np.full((9, 9), 300, np.int32)
    differences[1, 1] = -300
    differences[4:9, 3:8] = -300
    differences[6, 5] = 300
    labels, _ = settle(differences, 256)
    expected = np.zeros((9, 9), np.uint8)
    expected[4:9, 3:8] = 1
    assert (labels == expected).all()


def test_the_segmenters_energy_is_the_whole_of_equation_3():
    rng = np.random.default_rng(4)
    yuyv = rng.integers(60, 190, (48, 64, 2), dtype=np.uint8)
    yuyv[10:30, 16:40, 0] = 100
    yuyv[10:30, 16:40:2, 1], yuyv[10:30, 17:40:2, 1] = 90, 180
    settings_ = SegmentationConfig(width=80, light_std=0.0)
    found = Segmenter(MODEL, settings_, (64, 48)).segment(yuyv)
    yuv = yuv_from_yuyv(yuyv).astype(float)
    covariance = np.array(MODEL.covariance)
    gap = yuv - np.array(MODEL.mean)
    k = np.einsum("ijc,cd,ijd->ij", gap, np.linalg.inv(covariance), gap)
    own = 0.5 * (np.log((2 * np.pi) ** 3 * np.linalg.det(covariance)) + k)
    expected = np.where(found.mask == 1, own, 16.6).sum()
    expected += (found.mask[1:] != found.mask[:-1]).sum()
    expected += (found.mask[:, 1:] != found.mask[:, :-1]).sum()
    assert found.energy == pytest.approx(expected, abs=0.01 * found.mask.size)
    assert found.settled
    assert found.mask[12:28, 18:38].all()
