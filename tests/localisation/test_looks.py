"""Looks put together, against the least-squares solution of all of them at once."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from naod.localisation.ego import from_cartesian
from naod.localisation.looks import Look, combine

SPREAD_M = 0.001
"""Of the looks: near enough to each other that none is left out."""


def covariance(rng, sigma):
    A = rng.normal(size=(4, 4))
    return sigma**2 * (A @ A.T + 0.2 * np.eye(4))


def taken(seed, count, shared_sigma):
    """Looks at one place, each with a covariance of its own, and what they share."""
    rng = np.random.default_rng(seed)
    shared = covariance(rng, shared_sigma)
    place = np.array([0.8, -0.2, 0.4, 1.0])
    looks = []
    for n in range(count):
        ego = from_cartesian(*(place + SPREAD_M * rng.normal(size=4)))
        looks.append(Look(n, ego, covariance(rng, 0.004), shared))
    return looks


def stacked(looks):
    """Mean and covariance by generalised least squares over every number of every look."""
    n = len(looks)
    points = np.concatenate([[k.ego.x_m, k.ego.y_m, k.ego.z_m, k.ego.phi_rad] for k in looks])
    noise = np.kron(np.ones((n, n)), looks[0].shared)
    for i, k in enumerate(looks):
        noise[4 * i : 4 * i + 4, 4 * i : 4 * i + 4] += k.covariance
    design = np.tile(np.eye(4), (n, 1))
    whitened = np.linalg.solve(noise, np.column_stack([design, points]))
    information = design.T @ whitened[:, :4]
    return np.linalg.solve(information, design.T @ whitened[:, 4]), np.linalg.inv(information)


@settings(deadline=None, max_examples=60)
@given(
    st.integers(0, 2**32 - 1), st.integers(1, 12), st.sampled_from([0.0005, 0.003, 0.02])
)  # fmt: skip
def test_looks_together_are_the_least_squares_solution(seed, count, shared_sigma):
    looks = taken(seed, count, shared_sigma)
    together = combine(looks)
    mean, total = stacked(looks)
    ego = together.ego
    assert [ego.x_m, ego.y_m, ego.z_m, ego.phi_rad] == pytest.approx(mean, abs=1e-7)
    assert together.total == pytest.approx(total, rel=1e-5, abs=1e-12)


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 2**32 - 1), st.integers(2, 40))
def test_what_looks_share_does_not_average_out(seed, count):
    looks = taken(seed, count, 0.005)
    together = combine(looks)
    assert together.shared == pytest.approx(looks[0].shared)
    excess = together.total - looks[0].shared
    assert np.linalg.eigvalsh(excess).min() > 0.0
    for look in looks:
        assert np.linalg.eigvalsh(look.covariance - together.covariance).min() > -1e-12
    assert together.sigma_m >= np.sqrt(np.linalg.eigvalsh(looks[0].shared[:2, :2])[-1])


def test_the_blurred_look_counts_less():
    sharp = Look(0, from_cartesian(1.0, 0.0, 0.4, 3.0), np.eye(4) * 1e-6)
    smeared = Look(1, from_cartesian(1.01, 0.0, 0.4, 3.0), np.eye(4) * 9e-6, blur_px=8.0)
    together = combine([sharp, smeared])
    assert together.ego.x_m == pytest.approx(1.001)
    assert together.blur_px == pytest.approx(0.8)
