"""Stated covariances against the scatter of estimates from noisy edges."""

import numpy as np
import pytest
from edge_places import edge_places
from raster import BOARD, CAMERA, CAN, board_pose, can_pose

from naod.pose.reading import read_points
from naod.pose.uncertainty import EdgeNoise, covariance, misfit_ratio, point_sigma

CASES = [(CAN, can_pose((0.02, 0.05, 0.5), 0.5)), (BOARD, board_pose((0.0, 0.1, 0.8), 0.3, 0.4))]


INDEPENDENT = EdgeNoise(floor_px=0.05, common_px=0.0, edge_px=0.0, per_point=1.0, fits_px=2.0)


def read(shape, T, offsets):
    """A pose fitted to edge points so far outside the true outline, in pixels."""
    places, normals = edge_places(shape, T)
    return read_points(places + offsets[:, None] * normals, T, shape, CAMERA, 0.3, 2.0)


def misfit(reading):
    fit = reading.fit
    sigma = point_sigma(fit.residuals, fit.weights, reading.trust, 0.05)
    return misfit_ratio(fit.residuals, fit.weights, reading.trust, sigma)


def normalised_error(shape, T, offsets, noise):
    reading = read(shape, T, offsets)
    gap = reading.fit.T_camera_object[:3, 3] - T[:3, 3]
    return gap @ np.linalg.solve(covariance(reading, shape, noise)[:3, :3], gap) / 3.0


@pytest.mark.parametrize(("shape", "T"), CASES)
def test_independent_noise_is_stated_as_it_is(shape, T):
    rng = np.random.default_rng(7)
    errors = [normalised_error(shape, T, rng.normal(0, 0.4, 240), INDEPENDENT) for _ in range(150)]
    assert 0.75 < np.mean(errors) < 1.35


@pytest.mark.parametrize(("shape", "T"), CASES)
def test_an_outline_too_wide_or_narrow_as_a_whole_is_stated_too(shape, T):
    rng = np.random.default_rng(8)
    noise = EdgeNoise(floor_px=0.05, common_px=0.3, edge_px=0.0, per_point=1.0, fits_px=2.0)
    errors = [
        normalised_error(shape, T, rng.normal(0, 0.1, 240) + rng.normal(0, 0.3), noise)
        for _ in range(150)
    ]
    assert 0.2 < np.mean(errors) < 1.5


def test_the_turn_of_a_can_about_itself_has_no_variance():
    shape, T = CASES[0]
    reading = read(shape, T, np.zeros(240))
    total = covariance(reading, shape, EdgeNoise(0.3, 0.1, 0.1, 3.0, 1.0))
    axis = reading.fit.T_camera_object[:3, 1]
    assert axis @ total[3:, 3:] @ axis < 1e-6
    assert np.linalg.eigvalsh(total).min() > -1e-12


def test_a_shape_that_is_not_quite_the_described_one_is_less_sure():
    rng = np.random.default_rng(9)
    shape, T = CASES[1]
    noise = rng.normal(0, 0.2, 240)
    plain = read(shape, T, noise)
    assert misfit(plain) < 2.0
    bulging = noise + np.tile(1.5 * np.sin(np.linspace(0.0, np.pi, 60)), 4)
    bent = read(shape, T, bulging)
    assert misfit(bent) > 2.5
    spreads = [np.trace(covariance(r, shape, INDEPENDENT)[:3, :3]) for r in (plain, bent)]
    assert spreads[1] > 5.0 * spreads[0]
