"""Logistic regression against scikit-learn's, and its signs."""

import numpy as np
import pytest

from naod.finding.regression import fit_logistic, sigmoid


def made_up(n=400):
    rng = np.random.default_rng(3)
    rows = np.column_stack([np.ones(n), rng.normal(0.0, 1.0, (n, 3))])
    told = (rng.random(n) < sigmoid(rows @ (0.5, 2.0, -1.0, 0.3))).astype(np.float64)
    return rows, told, rng.uniform(0.2, 1.0, n)


def test_it_is_scikit_learns():
    linear = pytest.importorskip("sklearn.linear_model")
    rows, told, counts = made_up()
    theirs = linear.LogisticRegression(C=20.0, tol=1e-10, max_iter=1000)
    theirs.fit(rows[:, 1:], told, sample_weight=counts)
    ours = fit_logistic(rows, told, counts, np.zeros(4))
    assert np.allclose(ours[1:], theirs.coef_[0], atol=1e-3)
    assert np.isclose(ours[0], theirs.intercept_[0], atol=1e-3)


def test_a_weight_of_the_wrong_sign_is_left_out():
    rows, told, counts = made_up()
    weights = fit_logistic(rows, told, counts, np.array([0.0, 1.0, 1.0, 0.0]))
    assert weights[2] == 0.0
    assert weights[1] > 0.0
    without = fit_logistic(rows[:, [0, 1, 3]], told, counts, np.zeros(3))
    assert np.allclose(weights[[0, 1, 3]], without)
