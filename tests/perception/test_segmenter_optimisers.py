"""Segmenting a picture with either optimiser."""

from __future__ import annotations

import numpy as np
import pytest

from hal.yuyv import yuyv_from_rgb
from naod.config import SegmentationConfig
from naod.perception.blob import find_blob
from naod.perception.colour_model import Region, learn
from naod.perception.optimum import BETA_MAX
from naod.perception.quantising import C_BITS, Y_BITS
from naod.perception.segmenter import Segmentation, Segmenter

SIZE = (320, 240)
BOX = (slice(60, 180), slice(100, 200))


def noisy_picture(noise: float) -> np.ndarray:
    rgb = np.full((240, 320, 3), 110.0)
    rgb[BOX] = (190.0, 50.0, 45.0)
    rgb += np.random.default_rng(0).normal(0.0, noise, rgb.shape)
    return yuyv_from_rgb(np.clip(rgb, 0, 255))


def segmented(noise: float, **settings: object) -> Segmentation:
    model = learn([noisy_picture(12.0)], Region(110, 70, 80, 100))
    config = SegmentationConfig(**settings)  # type: ignore[arg-type]
    return Segmenter(model, config, SIZE).segment(noisy_picture(noise))


def energy_of(segmentation: Segmentation, **settings: object) -> float:
    """Equation 3 of a mask, every singleton and every pair written out in doubles.

    Colours are those in the middle of what the lookup does not tell apart.
    """
    model = learn([noisy_picture(12.0)], Region(110, 70, 80, 100))
    config = SegmentationConfig(**settings)  # type: ignore[arg-type]
    segmenter = Segmenter(model, config, SIZE)
    picture = segmenter.reduction(noisy_picture(40.0)).astype(np.float64)
    alike = np.array([256 >> Y_BITS, 256 >> C_BITS, 256 >> C_BITS])
    picture = (np.floor(picture / alike) + 0.5) * alike
    mean = np.array(model.mean)
    shades = config.light_std * (mean - (0.0, 128.0, 128.0))
    covariance = np.array(model.covariance) + np.outer(shades, shades)
    off = picture - mean
    k = np.einsum("ijc,cd,ijd->ij", off, np.linalg.inv(covariance), off)
    singleton = 0.5 * (k + np.log((2.0 * np.pi) ** 3 * np.linalg.det(covariance)))
    mask = segmentation.mask.astype(bool)
    broken = (mask[1:] != mask[:-1]).sum() + (mask[:, 1:] != mask[:, :-1]).sum()
    return float(np.where(mask, singleton, config.background_energy).sum() + config.beta * broken)


@pytest.mark.parametrize("optimiser", ["exact", "icm"])
def test_finds_the_box(optimiser: str) -> None:
    found = segmented(12.0, optimiser=optimiser)
    wanted = np.zeros((240, 320), dtype=bool)
    wanted[BOX] = True
    mask = np.kron(found.mask, np.ones((2, 2), dtype=np.uint8)) > 0
    assert (mask & wanted).sum() / (mask | wanted).sum() > 0.97
    assert found.settled
    assert find_blob(found) is not None


@pytest.mark.parametrize("optimiser", ["exact", "icm"])
@pytest.mark.parametrize("beta", [0.0, 1.0, 6.0])
def test_energy_is_that_of_the_mask(optimiser: str, beta: float) -> None:
    found = segmented(40.0, optimiser=optimiser, beta=beta)
    assert found.mask.any()
    # steps of 1/256 nat are cut off, not rounded
    slack = found.mask.sum() / 256.0
    assert found.energy == pytest.approx(
        energy_of(found, optimiser=optimiser, beta=beta), abs=slack
    )


def test_exact_is_below_icm_where_icm_is_stuck() -> None:
    exact, icm = (segmented(60.0, optimiser=name, beta=6.0) for name in ("exact", "icm"))
    assert exact.energy < icm.energy
    assert exact.iterations > 0
    assert icm.iterations > 1


def test_icm_says_when_it_ran_out_of_sweeps() -> None:
    assert not segmented(60.0, optimiser="icm", beta=6.0, sweeps_max=1).settled


def test_greatest_beta_allowed_is_within_the_optimums() -> None:
    assert BETA_MAX >= 1e5 * 256
    assert not segmented(60.0, beta=1e5).mask.any()
