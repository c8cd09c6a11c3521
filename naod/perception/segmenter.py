"""From a YUYV picture to a field of two labels at reduced size (equations 1 to 5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from naod.config import SegmentationConfig
from naod.perception.colour_model import ColourModel
from naod.perception.energy import STEPS, Singletons
from naod.perception.icm import descend, label_by_singletons
from naod.perception.optimum import Optimum
from naod.perception.reduction import Reduction


@dataclass(frozen=True, slots=True)
class Segmentation:
    """Labels of a picture.

    `mask`: (h, w) uint8, 1 = object. `energy`: of equation 3, in nat, the background's included.
    `scale`: full pixels per reduced pixel, in both directions. `size`: full width and height.
    `iterations`: sweeps of ICM, or waves of the exact cut, 0 where nothing was left to cut.
    `settled`: the energy came to rest within the sweeps allowed; the exact minimum always is.
    `differences`: (h, w) object's singleton energy less the background's, in steps.
    """

    mask: NDArray[np.uint8]
    energy: float
    iterations: int
    scale: float
    size: tuple[int, int]
    settled: bool
    differences: NDArray[np.int32] | None = None


class Segmenter:
    """Segments pictures of one size with one colour model; keeps its buffers between pictures."""

    def __init__(
        self, model: ColourModel, settings: SegmentationConfig, size: tuple[int, int]
    ) -> None:
        self.settings = settings
        self.reduction = Reduction(size, settings.width)
        self.singletons = Singletons(model, settings.background_energy, settings.light_std)
        shape = (self.reduction.height, self.reduction.width)
        self._differences = np.zeros(shape, dtype=np.int32)
        self._labels = np.zeros(shape, dtype=np.uint8)
        self._energies = np.zeros(settings.sweeps_max + 1, dtype=np.int64)
        self._optimum = Optimum(*shape)

    @property
    def beta_steps(self) -> int:
        """Beta in steps of the integer energy."""
        return round(self.settings.beta * STEPS)

    @property
    def settled_steps(self) -> int:
        """Change of energy below which it has settled; one step is the least there is."""
        return max(1, round(self.settings.settled * STEPS))

    def segment(self, yuyv: NDArray[np.uint8]) -> Segmentation:
        """Label a picture (H, W, 2) uint8 of the size given at the start; ValueError otherwise."""
        picture = self.reduction(yuyv)
        self.singletons.differences(picture, self._differences)
        exact = self.settings.optimiser == "exact"
        energy, iterations, settled = self._minimise() if exact else self._descend()
        return Segmentation(
            mask=self._labels.copy(),
            energy=self._labels.size * self.settings.background_energy + energy / STEPS,
            iterations=iterations,
            scale=float(self.reduction.block),
            size=self.reduction.size,
            settled=settled,
            differences=self._differences.copy(),
        )

    def _minimise(self) -> tuple[int, int, bool]:
        energy = self._optimum.minimise(self._differences, self.beta_steps, self._labels)
        return energy, self._optimum.waves, True

    def _descend(self) -> tuple[int, int, bool]:
        label_by_singletons(self._differences, self._labels)
        sweeps = descend(
            self._differences, self._labels, self.beta_steps, self.settled_steps, self._energies
        )
        last = int(self._energies[sweeps] - self._energies[sweeps - 1])
        return int(self._energies[sweeps]), sweeps, -last < self.settled_steps
