"""Logistic regression with signs that are known beforehand."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

RIDGE = 0.05
ITERATIONS = 60
TOLERANCE = 1e-8
EXPONENT_MAX = 30.0


def sigmoid(log_odds: Floats) -> Floats:
    """Probabilities of log-odds, same shape."""
    return np.asarray(1.0 / (1.0 + np.exp(-np.clip(log_odds, -EXPONENT_MAX, EXPONENT_MAX))))


def fit_logistic(rows: Floats, told: Floats, counts: Floats, signs: Floats) -> Floats:
    """Weights (k,) of greatest likelihood of `told` (n,) 0 or 1 under rows (n, k), `counts` (n,).

    The first column is a constant; a weight whose sign is not that of `signs` (k,), where that is
    not 0, is left out. A slight ridge keeps the rest finite.
    """
    free = np.ones(rows.shape[1], dtype=np.bool_)
    weights = np.zeros(rows.shape[1])
    while True:
        weights[:] = 0.0
        weights[free] = _newton(rows[:, free], told, counts)
        wrong = signs * weights < 0.0
        if not wrong.any():
            return weights
        free &= ~wrong


def _newton(rows: Floats, told: Floats, counts: Floats) -> Floats:
    ridge = RIDGE * np.eye(rows.shape[1])
    ridge[0, 0] = 1e-6
    weights = np.zeros(rows.shape[1])
    for _ in range(ITERATIONS):
        p = sigmoid(rows @ weights)
        gradient = rows.T @ (counts * (told - p)) - ridge @ weights
        information = (rows.T * (counts * p * (1.0 - p))) @ rows + ridge
        step = np.linalg.solve(information, gradient)
        weights += step
        if np.abs(step).max() < TOLERANCE:
            break
    return weights
