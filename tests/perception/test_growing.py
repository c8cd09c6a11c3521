"""From a marked region to the whole object: the cut along edges, and the parts of an object."""

from __future__ import annotations

import maxflow
import numpy as np
import pytest
from numpy.typing import NDArray

from naod.perception.components import components
from naod.perception.growing import grown
from naod.perception.growing_cut import PAIRS, least_energy, pair_weights
from naod.perception.growing_parts import hull_of, joined

RED, ORANGE, GREY = (80.0, 105.0, 200.0), (95.0, 95.0, 190.0), (120.0, 128.0, 128.0)
WHITE = (220.0, 128.0, 128.0)


def energy(
    differences: NDArray[np.int32], weights: NDArray[np.int32], labels: NDArray[np.uint8]
) -> int:
    total = int((differences.astype(np.int64) * labels).sum())
    height, width = labels.shape
    for weight, (down, right) in zip(weights, PAIRS, strict=True):
        for i in range(height - down):
            for j in range(max(0, -right), width - max(0, right)):
                total += int(weight[i, j]) * int(labels[i, j] != labels[i + down, j + right])
    return total


def by_peer(differences: NDArray[np.int32], weights: NDArray[np.int32]) -> NDArray[np.uint8]:
    graph = maxflow.Graph[int]()
    cells = graph.add_grid_nodes(differences.shape)
    for weight, (down, right) in zip(weights, PAIRS, strict=True):
        structure = np.zeros((3, 3))
        structure[1 + down, 1 + right] = 1
        graph.add_grid_edges(cells, weight, structure=structure, symmetric=True)
    graph.add_grid_tedges(cells, np.maximum(-differences, 0), np.maximum(differences, 0))
    graph.maxflow()
    return (~graph.get_grid_segments(cells)).astype(np.uint8)


def picture(shape: tuple[int, int] = (60, 80), seed: int = 0) -> NDArray[np.float32]:
    noise = np.random.default_rng(seed).normal(0.0, 1.5, (*shape, 3))
    return (noise + GREY).astype(np.float32)


def painted(
    image: NDArray[np.float32], place: tuple[slice, slice], colour: tuple[float, float, float]
) -> None:
    image[place] += np.array(colour, dtype=np.float32) - np.array(GREY, dtype=np.float32)


@pytest.mark.parametrize("seed", range(6))
def test_the_cut_has_the_energy_of_another_librarys(seed: int) -> None:
    rng = np.random.default_rng(seed)
    image = rng.uniform(0.0, 255.0, (17, 23, 3)).astype(np.float32)
    weights = pair_weights(image, 300, 0.1, 0.3, 3.0)
    differences = rng.normal(20.0 * seed, 300.0, (17, 23)).astype(np.int32)
    labels = least_energy(differences, weights)
    assert energy(differences, weights, labels) == energy(
        differences, weights, by_peer(differences, weights)
    )
    assert 0 < np.count_nonzero(labels) < labels.size


def test_a_window_of_weights_is_cut_as_a_field_of_its_own() -> None:
    rng = np.random.default_rng(9)
    weights = pair_weights(rng.uniform(0.0, 255.0, (20, 20, 3)).astype(np.float32), 300, 0.1, 1, 3)
    window = np.ascontiguousarray(weights[:, 3:14, 2:15])
    differences = rng.normal(0.0, 300.0, window.shape[1:]).astype(np.int32)
    labels, peer = least_energy(differences, window), window.copy()
    for weight, (down, right) in zip(peer, PAIRS, strict=True):
        weight[weight.shape[0] - down :] = 0
        weight[:, : max(0, -right)] = 0
        weight[:, weight.shape[1] - max(0, right) :] = 0
    assert energy(differences, window, labels) == energy(
        differences, window, by_peer(differences, peer)
    )


def test_neighbours_across_an_edge_hold_together_less() -> None:
    image = picture()
    painted(image, (slice(None), slice(40, None)), RED)
    along, down = pair_weights(image, 1000, 0.1, 0.3, 3.0)[:2]
    assert along[:, 39].max() < 0.2 * np.median(along[:, :39])
    assert np.median(down[:-1, 39]) > 0.8 * np.median(down[:-1])


def test_what_touches_the_object_and_has_nearly_its_colour_stays_outside() -> None:
    image = picture()
    painted(image, (slice(20, 40), slice(30, 45)), RED)
    painted(image, (slice(10, 50), slice(45, 70)), ORANGE)
    truth = np.zeros(image.shape[:2], dtype=np.bool_)
    truth[20:40, 30:45] = True
    marked = np.zeros_like(truth)
    marked[27:33, 34:40] = True
    found = grown(image, marked)
    assert np.count_nonzero(found & truth) > 0.95 * np.count_nonzero(found | truth)


def test_a_ribbon_does_not_end_the_object() -> None:
    image = picture(seed=1)
    painted(image, (slice(15, 45), slice(30, 48)), RED)
    image[27:31, 30:48] = np.array(WHITE, dtype=np.float32)
    truth = np.zeros(image.shape[:2], dtype=np.bool_)
    truth[15:45, 30:48] = True
    marked = np.zeros_like(truth)
    marked[33:42, 33:45] = True
    found = grown(image, marked)
    assert np.count_nonzero(found & truth) > 0.95 * np.count_nonzero(found | truth)


@pytest.mark.parametrize(("gap", "together"), [(4, True), (20, False)])
def test_parts_are_joined_when_they_are_near_and_fill_their_hull(gap: int, together: bool) -> None:
    mask = np.zeros((60, 40), dtype=np.bool_)
    mask[5:20, 10:25] = True
    mask[20 + gap : 35 + gap, 10:25] = True
    image = picture((60, 40))
    painted(image, (slice(5, 35 + gap), slice(10, 25)), RED)
    image[20 : 20 + gap, 10:25] = np.array(WHITE, dtype=np.float32)
    parts, table = components(mask.astype(np.uint8))
    known = parts == 1
    found = joined(known, parts, table, pair_weights(image, 1536, 0.1, 0.3, 3.0))
    assert (found == (hull_of(mask) if together else known)).all()
