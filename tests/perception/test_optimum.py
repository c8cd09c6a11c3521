"""The exact optimum against every labelling, and against another library's minimum cut."""

from __future__ import annotations

import itertools

import maxflow
import numpy as np
import pytest
from numpy.typing import NDArray
from random_fields import STATISTICS, random_field

from naod.perception.energy import field_energy
from naod.perception.icm import descend, label_by_singletons
from naod.perception.optimum import BETA_MAX, Optimum

TINY = [(1, 1), (1, 2), (2, 1), (1, 9), (9, 1), (2, 2), (2, 5), (3, 3), (3, 4), (4, 4)]


def minimum(differences: NDArray[np.int32], beta: int) -> tuple[NDArray[np.uint8], int]:
    labels = np.full(differences.shape, 7, dtype=np.uint8)
    energy = Optimum(*differences.shape).minimise(differences, beta, labels)
    return labels, energy


def all_energies(
    differences: NDArray[np.int32], beta: int
) -> tuple[NDArray[np.uint8], NDArray[np.int64]]:
    """Every labelling there is (2^n, h, w), and its energy."""
    n = differences.size
    bits = np.arange(2**n)[:, None] >> np.arange(n) & 1
    labels = bits.astype(np.uint8).reshape(-1, *differences.shape)
    broken = np.abs(np.diff(labels.astype(np.int64), axis=1)).sum(axis=(1, 2))
    broken += np.abs(np.diff(labels.astype(np.int64), axis=2)).sum(axis=(1, 2))
    return labels, (labels * differences.astype(np.int64)).sum(axis=(1, 2)) + beta * broken


def energy_of_peer(differences: NDArray[np.int32], beta: int) -> int:
    """PyMaxflow's minimum, evaluated apart from it."""
    graph = maxflow.Graph[int]()
    cells = graph.add_grid_nodes(differences.shape)
    graph.add_grid_edges(cells, beta, symmetric=True)
    graph.add_grid_tedges(cells, np.maximum(-differences, 0), np.maximum(differences, 0))
    graph.maxflow()
    labels = (~graph.get_grid_segments(cells)).astype(np.uint8)
    return field_energy(differences, labels, beta)


@pytest.mark.parametrize("shape", TINY)
def test_is_the_least_of_all_minima_among_every_labelling(shape: tuple[int, int]) -> None:
    rng = np.random.default_rng(sum(shape))
    for beta, spread in itertools.product((0, 1, 2, 5, 40), (1, 3, 12, 60)):
        differences = rng.integers(-spread, spread + 1, shape).astype(np.int32)
        labellings, energies = all_energies(differences, beta)
        minima = labellings[energies == energies.min()]
        labels, energy = minimum(differences, beta)
        assert energy == energies.min()
        assert (labels == minima.min(axis=0)).all()


@pytest.mark.parametrize("statistics", STATISTICS)
@pytest.mark.parametrize("shape", [(1, 1), (1, 31), (23, 1), (7, 8), (17, 40), (48, 63)])
def test_has_the_energy_of_another_library(statistics: str, shape: tuple[int, int]) -> None:
    optimum = Optimum(*shape)
    labels = np.zeros(shape, dtype=np.uint8)
    for seed, beta in enumerate((0, 1, 30, 100, 150, 256, 1000, 20000)):
        differences = random_field(statistics, shape, seed)
        energy = optimum.minimise(differences, beta, labels)
        assert energy == field_energy(differences, labels, beta)
        assert energy == energy_of_peer(differences, beta)


@pytest.mark.parametrize("statistics", STATISTICS)
@pytest.mark.parametrize("beta", [40, 256, 3000])
def test_has_the_energy_of_another_library_at_full_size(statistics: str, beta: int) -> None:
    differences = random_field(statistics, (120, 160), seed=beta)
    assert minimum(differences, beta)[1] == energy_of_peer(differences, beta)


def test_extremes_of_the_integers_do_not_overflow() -> None:
    ends = np.array([-(2**31), 2**31 - 1, -1, 0, 1], dtype=np.int32)
    for seed, beta in itertools.product(range(20), (0, 1, 1 << 20, BETA_MAX)):
        differences = np.random.default_rng(seed).choice(ends, (3, 4))
        assert minimum(differences, beta)[1] == all_energies(differences, beta)[1].min()
    needs = random_field("noise", (30, 40), 0) * np.int32(4 * BETA_MAX // 300)
    assert minimum(needs, BETA_MAX)[1] == energy_by_float_peer(needs, BETA_MAX)


def energy_by_float_peer(differences: NDArray[np.int32], beta: int) -> int:
    """The peer's integers are 32 bits wide; doubles hold these sums exactly."""
    graph = maxflow.Graph[float]()
    cells = graph.add_grid_nodes(differences.shape)
    graph.add_grid_edges(cells, float(beta), symmetric=True)
    wide = differences.astype(np.float64)
    graph.add_grid_tedges(cells, np.maximum(-wide, 0), np.maximum(wide, 0))
    graph.maxflow()
    labels = (~graph.get_grid_segments(cells)).astype(np.uint8)
    return field_energy(differences, labels, beta)


@pytest.mark.parametrize("statistics", STATISTICS)
def test_icm_ends_no_lower(statistics: str) -> None:
    differences = random_field(statistics, (48, 64), 5)
    labels = np.zeros(differences.shape, dtype=np.uint8)
    energies = np.zeros(51, dtype=np.int64)
    label_by_singletons(differences, labels)
    sweeps = descend(differences, labels, 256, 1, energies)
    assert minimum(differences, 256)[1] <= energies[sweeps]


def test_a_tie_is_background() -> None:
    assert not minimum(np.zeros((6, 7), dtype=np.int32), 10)[0].any()
    pair = np.array([[-5, 5]], dtype=np.int32)
    assert not minimum(pair, 100)[0].any()
    assert minimum(pair - np.int32([[1, 0]]), 100)[0].all()
