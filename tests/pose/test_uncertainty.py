"""Stated covariances against the scatter of estimates from noisy edges."""

import cv2
import numpy as np
import pytest
from edge_places import edge_places
from raster import BOARD, CAMERA, CAN, board_pose, can_pose

from naod.pose.noise import EdgeNoise
from naod.pose.reading import read_points
from naod.pose.shared import give_way, point_sigma
from naod.pose.uncertainty import add_turn, covariance, misfit_ratio

CASES = [(CAN, can_pose((0.02, 0.05, 0.5), 0.5)), (BOARD, board_pose((0.0, 0.1, 0.8), 0.3, 0.4))]


def noise_of(common_px=0.0, edge_px=0.0):
    return EdgeNoise(
        floor_px=0.05,
        common_px=common_px,
        edge_px=edge_px,
        edge_per_blur=0.0,
        edge_per_rise=0.0,
        per_odd=0.0,
        per_point=1.0,
        fits_px=2.0,
    )


INDEPENDENT = noise_of()


def read(shape, T, offsets, noise=INDEPENDENT):
    """A pose fitted to edge points so far outside the true outline, in pixels."""
    places, normals = edge_places(shape, T)
    return read_points(places + offsets[:, None] * normals, T, shape, CAMERA, 0.3, noise)


def misfit(reading):
    fit = reading.fit
    rest = (fit.groups, fit.offsets)
    sigma = point_sigma(fit.residuals, fit.weights, reading.trust, *rest, 0.05)
    return misfit_ratio(fit.residuals, fit.weights, reading.trust, *rest, sigma)


def normalised_error(shape, T, offsets, noise):
    reading = read(shape, T, offsets, noise)
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
    noise = noise_of(common_px=0.3)
    errors = [
        normalised_error(shape, T, rng.normal(0, 0.1, 240) + rng.normal(0, 0.3), noise)
        for _ in range(150)
    ]
    assert 0.2 < np.mean(errors) < 1.5


@pytest.mark.parametrize(("shape", "T"), CASES)
def test_edges_that_are_each_off_as_a_whole_are_stated_as_they_are(shape, T):
    rng = np.random.default_rng(10)
    noise = noise_of(edge_px=0.3)
    places = edge_places(shape, T)[0]
    x, y = (places - places.mean(axis=0)).T
    of = np.empty(240, dtype=int)
    of[np.argsort(np.arctan2(y, x))] = read(shape, T, np.zeros(240)).fit.edges
    errors = [
        normalised_error(shape, T, rng.normal(0, 0.1, 240) + rng.normal(0, 0.3, 4)[of], noise)
        for _ in range(150)
    ]
    assert 0.6 < np.mean(errors) < 1.5


def test_offsets_of_edges_are_as_if_they_were_unknowns_of_their_own():
    """Eliminated from the normal equations, against a system that has them all."""
    rng = np.random.default_rng(11)
    J, r, w = rng.normal(size=(40, 6)), rng.normal(size=40), rng.uniform(0.2, 1.0, 40)
    of, spreads = rng.integers(0, 4, 40), np.array([0.3, 0.6, 0.2, 0.5])
    shares = np.eye(4)[of]
    A, b, offsets = (J.T * w) @ J, -(J.T * w) @ r, np.zeros(4)
    give_way(
        shares.T @ (w[:, None] * J), shares.T @ w, shares.T @ (w * r), spreads, 1.0, offsets,
        np.empty(4), A, b,
    )  # fmt: skip
    A = np.tril(A) + np.tril(A, -1).T
    # residual = r + J x - offset, and the offsets are 0 to within their spreads
    whole = np.hstack([J, -shares])
    prior = np.diag(np.concatenate([np.zeros(6), spreads**-2.0]))
    found = np.linalg.solve((whole.T * w) @ whole + prior, -(whole.T * w) @ r)
    assert np.allclose(np.linalg.solve(A, b), found[:6])


def test_the_turn_of_a_can_about_itself_has_no_variance():
    shape, T = CASES[0]
    reading = read(shape, T, np.zeros(240))
    total = covariance(reading, shape, noise_of(common_px=0.1, edge_px=0.1))
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


def test_a_turn_of_the_camera_is_that_of_poses_turned_about_it():
    t, sigma = np.array([0.3, -0.1, 0.9]), 0.004
    rng = np.random.default_rng(12)
    turns = np.zeros((20_000, 3))
    turns[:, :2] = rng.normal(0.0, sigma, (20_000, 2))
    moves = np.array([cv2.Rodrigues(turn)[0] @ t - t for turn in turns])
    stated = np.zeros((6, 6))
    add_turn(t, sigma, stated)
    scatter = np.cov(np.hstack([moves, turns]).T)
    assert np.allclose(stated, scatter, atol=0.03 * sigma**2)
