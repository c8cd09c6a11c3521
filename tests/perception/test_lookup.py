"""The table that stands for a colour model, and the places of block means in it."""

from __future__ import annotations

import numpy as np
import pytest

from naod.config import SegmentationConfig
from naod.perception.colour_model import ColourModel
from naod.perception.energy import STEPS, Singletons
from naod.perception.quantising import C_BITS, Y_BITS, kind_of
from naod.perception.reduction import Reduction
from naod.perception.segmenter import Segmenter

MODEL = ColourModel(
    mean=(90.0, 110.0, 170.0),
    covariance=((400.0, 30.0, -20.0), (30.0, 60.0, 5.0), (-20.0, 5.0, 90.0)),
)
ALIKE = np.array([256 >> Y_BITS, 256 >> C_BITS, 256 >> C_BITS])
LAYOUTS = [
    ((160, 120), 160),
    ((320, 240), 160),
    ((640, 480), 160),
    ((640, 480), 320),
    ((640, 480), 80),
    ((1280, 960), 80),
    ((480, 30), 160),
    ((322, 241), 160),
    ((36, 22), 5),
]


def colours(size: tuple[int, int], seed: int) -> np.ndarray:
    """Noise about patches, so that many places are met."""
    rng = np.random.default_rng(seed)
    width, height = size
    coarse = rng.integers(0, 256, (height // 8 + 1, width // 8 + 1, 2))
    fine = np.repeat(np.repeat(coarse, 8, axis=0), 8, axis=1)[:height, :width]
    return np.clip(fine + rng.integers(-9, 10, fine.shape), 0, 255).astype(np.uint8)


@pytest.mark.parametrize(("size", "width"), LAYOUTS)
def test_a_pixel_costs_what_the_middle_of_its_place_costs(
    size: tuple[int, int], width: int
) -> None:
    yuyv = colours(size, 1)
    # a width that the configuration does not offer makes blocks of odd sizes
    settings = SegmentationConfig(width=width)  # type: ignore[arg-type]
    found = Segmenter(MODEL, settings, size).segment(yuyv)
    means = Reduction(size, width)(yuyv)
    middles = ((np.floor(means / ALIKE) + 0.5) * ALIKE).astype(np.float32)
    expected = np.empty(means.shape[:2], dtype=np.int32)
    Singletons(MODEL, settings.background_energy, settings.light_std).differences(middles, expected)
    assert found.differences is not None
    assert (found.differences == expected).mean() > 0.999


def test_layouts_meet_every_kind_of_block() -> None:
    kinds = {kind_of(size, Reduction(size, width).block) for size, width in LAYOUTS}
    assert kinds == {0, 1, 2, 4, 8, 16}


def test_another_model_is_taken_as_if_from_the_start() -> None:
    other = ColourModel(mean=(60.0, 140.0, 120.0), covariance=MODEL.covariance)
    yuyv = colours((640, 480), 2)
    segmenter = Segmenter(MODEL, SegmentationConfig(), (640, 480))
    before = segmenter.segment(yuyv)
    segmenter.take(other)
    after = segmenter.segment(yuyv)
    fresh = Segmenter(other, SegmentationConfig(), (640, 480)).segment(yuyv)
    assert (after.mask == fresh.mask).all()
    assert after.energy == fresh.energy
    assert before.energy != after.energy


def test_costs_are_kept_to_a_fraction_of_a_nat_near_the_threshold() -> None:
    """Where labels are decided, a place's colours differ by less than a few neighbours' votes."""
    rng = np.random.default_rng(3)
    spread = np.linalg.cholesky(np.array(MODEL.covariance))
    near = (np.array(MODEL.mean) + rng.normal(0.0, 2.0, (1, 4000, 3)) @ spread.T).astype(np.float32)
    near = np.clip(near, 0, 255)
    singletons = Singletons(MODEL, 16.6, 0.12)
    exact, kept = (np.empty(near.shape[:2], dtype=np.int32) for _ in range(2))
    singletons.differences(near, exact)
    middles = ((np.floor(near / ALIKE) + 0.5) * ALIKE).astype(np.float32)
    singletons.differences(middles, kept)
    gaps_nat = np.abs(exact - kept) / STEPS
    assert np.median(gaps_nat) < 0.25
    assert np.percentile(gaps_nat, 99) < 2.0
