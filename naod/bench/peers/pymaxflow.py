"""The same energy minimised by PyMaxflow (Boykov and Kolmogorov 2004), the referee."""

from __future__ import annotations

import maxflow
import numpy as np
from numpy.typing import NDArray

from naod.bench.peers.peer import STILL, Motion, Seen
from naod.bench.peers.pictures import box_of
from naod.config import SegmentationConfig
from naod.perception.colour_model import Region, learn
from naod.perception.segmenter import Segmenter


class PyMaxflow:
    """Our colours and our integers, their cut."""

    def __init__(self, size: tuple[int, int]) -> None:
        self._size = size
        self._segmenter: Segmenter | None = None

    def learn(self, yuyv: NDArray[np.uint8], region: Region) -> None:
        """One Gaussian of the region."""
        self._segmenter = Segmenter(learn([yuyv], region), SegmentationConfig(), self._size)

    def segment(self, yuyv: NDArray[np.uint8], _motion_px: Motion = STILL) -> Seen:
        """Singletons, graph, cut, box."""
        segmenter = self._segmenter
        assert segmenter is not None
        picture = segmenter.reduction(yuyv)
        differences = np.empty(picture.shape[:2], dtype=np.int32)
        segmenter.singletons.differences(picture, differences)
        mask = minimum(differences, segmenter.beta_steps)
        return box_of(mask, float(segmenter.reduction.block))


def minimum(differences: NDArray[np.int32], beta: int) -> NDArray[np.uint8]:
    """Labels (h, w) of least energy for (h, w) differences, 1 = object."""
    graph = maxflow.GraphInt()
    nodes = graph.add_grid_nodes(differences.shape)
    graph.add_grid_edges(nodes, beta)
    graph.add_grid_tedges(nodes, np.maximum(-differences, 0), np.maximum(differences, 0))
    graph.maxflow()
    # the source's side has the object's label: cutting it off costs what the object would save
    return np.asarray(~graph.get_grid_segments(nodes), dtype=np.uint8)


def make(size: tuple[int, int]) -> PyMaxflow:
    """For pictures of that size."""
    return PyMaxflow(size)
