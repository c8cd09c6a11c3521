"""On pictures of the simulated robot: the energy of another library's minimum cut."""

from __future__ import annotations

import maxflow
import numpy as np
import pytest
from numpy.typing import NDArray

from naod.config import SegmentationConfig
from naod.perception.colour_model import learn
from naod.perception.energy import STEPS, field_energy
from naod.perception.segmenter import Segmenter

frames_module = pytest.importorskip("naod.bench.frames")
BETA = round(SegmentationConfig().beta * STEPS)


@pytest.fixture(scope="module", params=[0.0, 0.033], ids=["sharp", "blurred"])
def walk(request: pytest.FixtureRequest):
    """Three frames of an approach."""
    pytest.importorskip("pybullet")
    settings = frames_module.WalkSettings(count=3, size=(320, 240))
    return frames_module.Walk(settings).taken("", request.param)


def energy_of_peer(differences: NDArray[np.int32]) -> int:
    graph = maxflow.Graph[int]()
    cells = graph.add_grid_nodes(differences.shape)
    graph.add_grid_edges(cells, BETA, symmetric=True)
    graph.add_grid_tedges(cells, np.maximum(-differences, 0), np.maximum(differences, 0))
    graph.maxflow()
    labels = (~graph.get_grid_segments(cells)).astype(np.uint8)
    return field_energy(differences, labels, BETA)


def test_the_energy_is_the_least_there_is(walk) -> None:
    segmenter = Segmenter(learn([walk.shown], walk.region), SegmentationConfig(), (320, 240))
    for frame in walk.frames:
        found = segmenter.segment(frame.yuyv)
        energy = field_energy(found.differences, found.mask, BETA)
        assert energy == energy_of_peer(found.differences)
        above = found.energy - found.mask.size * SegmentationConfig().background_energy
        assert above * STEPS == pytest.approx(energy, abs=0.01)
        assert found.mask.any()
