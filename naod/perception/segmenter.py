"""From a YUYV picture to a field of two labels at reduced size (equations 1 to 5)."""

from __future__ import annotations

import msgspec
import numpy as np
from numpy.typing import NDArray

from naod.config import SegmentationConfig
from naod.perception.colour_model import ColourModel
from naod.perception.energy import STEPS, Singletons
from naod.perception.icm import descend, label_by_singletons
from naod.perception.lookup import Lookup
from naod.perception.quantising import kind_of
from naod.perception.reduction import Reduction
from naod.perception.seeing import choose_in_mask, measure, scratch, see
from naod.perception.sight import Sight, Sights

_LEVELS = np.dtype(np.uint8)


class Segmentation(msgspec.Struct, frozen=True, eq=False):
    """Labels of a picture.

    `mask`: (h, w) uint8, 1 = object. `energy`: of equation 3, in nat, the background's included.
    `scale`: full pixels per reduced pixel, in both directions. `size`: full width and height.
    `iterations`: sweeps of ICM, or waves of the exact cut, 0 where nothing was left to cut.
    `settled`: the energy came to rest within the sweeps allowed; the exact minimum always is.
    `given`: (h, w) int32 `differences` of a mask that no segmenter made, if they are known.
    `sight`: the memory that a segmenter lent for this, which is used again once nobody holds this,
    its mask, its differences, or anything of its blob.
    """

    mask: NDArray[np.uint8]
    energy: float
    iterations: int
    scale: float
    size: tuple[int, int]
    settled: bool
    given: NDArray[np.int32] | None = None
    sight: Sight | None = None

    @property
    def differences(self) -> NDArray[np.int32] | None:
        """(h, w) object's singleton energy less the background's, in steps; None if unknown."""
        return self.given if self.sight is None else self.sight.differences


class Segmenter:
    """Segments pictures of one size with one colour model, in memory taken at the start.

    `reduction` and `singletons` are what its lookup stands for: the mean of each block, and what
    that colour costs.
    """

    def __init__(
        self, model: ColourModel, settings: SegmentationConfig, size: tuple[int, int]
    ) -> None:
        self.settings = settings
        self.model = model
        self.reduction = Reduction(size, settings.width)
        self.singletons = Singletons(model, settings.background_energy, settings.light_std)
        self._lookup = Lookup(self.singletons, self.beta_steps)
        height, width = self.reduction.height, self.reduction.width
        self._shape = (size[1], size[0], 2)
        self._background = height * width * settings.background_energy
        self._energies = np.zeros(settings.sweeps_max + 1, dtype=np.int64)
        self._kind = kind_of(size, self.reduction.block)
        self._memory = scratch(height, width, size[0])
        self._sights = Sights(height, width, settings.pixels_min)
        self._exact = settings.optimiser == "exact"
        # looked up once: where caches are cold, every attribute on the way costs time
        self._fixed = (
            self._kind,
            self.reduction.block,
            self._lookup.votes,
            self._lookup.values,
            self._memory,
            height,
            width,
            self.beta_steps,
            settings.pixels_min,
        )

    @property
    def beta_steps(self) -> int:
        """Beta in steps of the integer energy."""
        return round(self.settings.beta * STEPS)

    @property
    def settled_steps(self) -> int:
        """Change of energy below which it has settled; one step is the least there is."""
        return max(1, round(self.settings.settled * STEPS))

    def take(self, model: ColourModel) -> None:
        """Go on with another colour model; about a millisecond, and no memory."""
        settings = self.settings
        self._sights.look_up()
        self.model = model
        self.singletons = Singletons(model, settings.background_energy, settings.light_std)
        self._lookup.rebuild(self.singletons, self.beta_steps)

    def segment(self, yuyv: NDArray[np.uint8]) -> Segmentation:
        """Label a picture (H, W, 2) uint8 of the size given at the start; ValueError otherwise.

        No array is made as long as what came of earlier pictures has been dropped, all but the
        last; see `Sights`.
        """
        raw = self._raw(yuyv)
        sight = self._sights.take()
        energy, iterations, settled = (self._minimise if self._exact else self._descend)(raw, sight)
        return Segmentation(
            mask=sight.mask,
            energy=self._background + energy / STEPS,
            iterations=iterations,
            scale=float(self.reduction.block),
            size=self.reduction.size,
            settled=settled,
            sight=sight,
        )

    def _raw(self, yuyv: NDArray[np.uint8]) -> NDArray[np.uint8]:
        if yuyv.shape != self._shape or yuyv.dtype != _LEVELS:
            height, width, _ = self._shape
            raise ValueError(f"expected a uint8 YUYV picture {width}x{height}, got {yuyv.shape}")
        raw = yuyv.view() if yuyv.flags.c_contiguous else np.ascontiguousarray(yuyv)
        # whether a picture may be written to is part of its type: one type, one compilation
        raw.setflags(write=False)
        return raw

    def _minimise(self, raw: NDArray[np.uint8], sight: Sight) -> tuple[int, int, bool]:
        found = see(raw, sight.memory, *self._fixed)
        energy, waves, sight.pixels, sight.points, sight.cut, sight.run_count, sight.regions = found
        sight.values = self._lookup.values
        return energy, waves, True

    def _descend(self, raw: NDArray[np.uint8], sight: Sight) -> tuple[int, int, bool]:
        block, (height, width) = self.reduction.block, sight.mask.shape
        values, mask = self._lookup.values, sight.mask
        measure(raw, sight.memory, self._kind, block, values, self._memory, height, width)
        # they are there: nothing is left to look up
        sight.values = None
        differences = sight.differences
        label_by_singletons(differences, mask)
        sweeps = descend(differences, mask, self.beta_steps, self.settled_steps, self._energies)
        found = choose_in_mask(
            values, self._memory, sight.memory, height, width, sight.pixels_min, float(block)
        )
        sight.pixels, sight.points, sight.cut, sight.run_count, sight.regions = found
        last = int(self._energies[sweeps] - self._energies[sweeps - 1])
        return int(self._energies[sweeps]), sweeps, -last < self.settled_steps
