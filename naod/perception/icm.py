"""Iterated conditional modes on a two-label field (equation 4, Algorithm 2 put right)."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.energy import field_energy


@njit(cache=True, nogil=True)
def label_by_singletons(differences: NDArray[np.int32], labels: NDArray[np.uint8]) -> None:
    """The minimum of the singleton terms alone; (h, w) int32 into (h, w) uint8."""
    for i in range(differences.shape[0]):
        for j in range(differences.shape[1]):
            labels[i, j] = 1 if differences[i, j] < 0 else 0


@njit(cache=True, nogil=True)
def best_label(
    differences: NDArray[np.int32], labels: NDArray[np.uint8], beta: int, i: int, j: int
) -> tuple[int, int]:
    """The label of least energy given the four neighbours, and how the energy changes by it.

    A tie keeps the present label, so that the energy falls strictly and the search ends.
    """
    balance = 0
    if i > 0:
        balance += 1 - 2 * labels[i - 1, j]
    if i + 1 < labels.shape[0]:
        balance += 1 - 2 * labels[i + 1, j]
    if j > 0:
        balance += 1 - 2 * labels[i, j - 1]
    if j + 1 < labels.shape[1]:
        balance += 1 - 2 * labels[i, j + 1]
    rise = differences[i, j] + beta * balance
    if labels[i, j] == 0:
        return (1, rise) if rise < 0 else (0, 0)
    return (0, -rise) if rise > 0 else (1, 0)


@njit(cache=True, nogil=True)
def descend(
    differences: NDArray[np.int32],
    labels: NDArray[np.uint8],
    beta: int,
    settled: int,
    energies: NDArray[np.int64],
) -> int:
    """Sweep in place until a sweep lowers the energy by less than `settled`, at least 1.

    `energies`, (sweeps at most + 1,) int64: the energy before the first sweep and after each one,
    above that of the all-background field. Returns the number of sweeps.
    """
    energies[0] = field_energy(differences, labels, beta)
    for sweep in range(1, energies.size):
        change = 0
        for i in range(labels.shape[0]):
            for j in range(labels.shape[1]):
                label, difference = best_label(differences, labels, beta, i, j)
                labels[i, j] = label
                change += difference
        energies[sweep] = energies[sweep - 1] + change
        if -change < settled:
            return sweep
    return energies.size - 1
