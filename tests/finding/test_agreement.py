"""Densities of where the object is expected, against numpy's way to the same number."""

import numpy as np

from naod.finding.expectation import gaussians


def test_densities_are_those_of_inverse_and_determinant():
    rng = np.random.default_rng(4)
    for _ in range(20):
        root = rng.normal(0.0, 0.1, (3, 3))
        spread, sigmas = root @ root.T, rng.uniform(0.05, 0.5, (4, 3))
        gaps = rng.normal(0.0, 0.2, (4, 3))
        found = gaussians(gaps, spread, sigmas)
        for k in range(4):
            covariance = spread + np.diag(sigmas[k] ** 2)
            exponent = -0.5 * gaps[k] @ np.linalg.inv(covariance) @ gaps[k]
            scale = np.sqrt(np.linalg.det(2.0 * np.pi * covariance))
            assert np.isclose(found[k], np.exp(exponent) / scale, rtol=1e-6)
