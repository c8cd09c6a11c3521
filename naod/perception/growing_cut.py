"""The least energy of a field of two labels whose neighbours hold together less across edges.

Eight neighbours, and for each pair its own weight: a minimum cut, by waves of pushes. A pixel's
excess is what it costs to make it object, a negative one is a need. Each wave finds the steps from
every pixel to the nearest need it can still reach and lets all excess flow downhill, farthest
first. Once no excess reaches a need, what reaches one is object (Goldberg and Tarjan 1988, the
distances made exact in every round).
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

Floats = NDArray[np.float64]

PAIRS = ((0, 1), (1, 0), (1, 1), (1, -1))
"""Rows down and columns right from a pixel to four of its neighbours; the others mirror these."""

_UNSEEN = np.int32(1 << 30)


@njit(cache=True, nogil=True)
def pair_weights(
    picture: NDArray[np.float32], beta: int, least: float, contrast: float, chroma: float
) -> NDArray[np.int32]:
    """(4, h, w) of each pixel and its neighbour in PAIRS, 0 beyond the picture.

    `beta` between equal colours, `least` of it across the strongest edges; it falls by a factor
    e where colours (h, w, 3) differ by the picture's mean square times 2 `contrast`. `chroma`:
    what U and V count beside Y.
    """
    height, width = picture.shape[:2]
    squares = np.zeros((4, height, width), dtype=np.float64)
    total, count = 0.0, 0
    for k in range(4):
        down, right = PAIRS[k]
        for i in range(height - down):
            for j in range(max(0, -right), width - max(0, right)):
                a, b = picture[i, j], picture[i + down, j + right]
                u, v = chroma * (a[1] - b[1]), chroma * (a[2] - b[2])
                squares[k, i, j] = (a[0] - b[0]) ** 2 + u**2 + v**2
                total += squares[k, i, j]
                count += 1
    scale = 2.0 * contrast * max(total / max(count, 1), 1.0)
    weights = np.zeros((4, height, width), dtype=np.int32)
    for k in range(4):
        down, right = PAIRS[k]
        near = beta * (1.0 if k < 2 else np.sqrt(0.5))
        for i in range(height - down):
            for j in range(max(0, -right), width - max(0, right)):
                share = least + (1.0 - least) * np.exp(-squares[k, i, j] / scale)
                weights[k, i, j] = np.int32(near * share)
    return weights


@njit(cache=True, nogil=True)
def _capacities(weights: NDArray[np.int32], stride: int, capacity: NDArray[np.int32]) -> None:
    """Both ways between neighbours of a field with a border of one pixel."""
    height, width = weights.shape[1:]
    for k in range(4):
        down, right = PAIRS[k]
        step = down * stride + right
        # a window of a larger field has weights to what is beyond it
        for i in range(height - down):
            for j in range(max(0, -right), width - max(0, right)):
                cell = (i + 1) * stride + j + 1
                capacity[cell, k] = weights[k, i, j]
                capacity[cell + step, k + 4] = weights[k, i, j]


@njit(cache=True, nogil=True)
def _levels(
    excess: NDArray[np.int64],
    capacity: NDArray[np.int32],
    steps: NDArray[np.int64],
    level: NDArray[np.int32],
    queue: NDArray[np.int64],
) -> tuple[int, bool]:
    """Queue all that reaches a need, nearest first; how many, and whether any has excess."""
    count = 0
    for cell in range(excess.size):
        level[cell] = _UNSEEN
        if excess[cell] < 0:
            level[cell] = 0
            queue[count] = cell
            count += 1
    k, flows = 0, False
    while k < count:
        cell = queue[k]
        k += 1
        for side in range(8):
            other = cell - steps[side]
            # nothing flows from beyond the border: it has no capacity
            if capacity[other, side] > 0 and level[other] == _UNSEEN:
                level[other] = level[cell] + 1
                flows |= excess[other] > 0
                queue[count] = other
                count += 1
    return count, flows


@njit(cache=True, nogil=True)
def _wave(
    excess: NDArray[np.int64],
    capacity: NDArray[np.int32],
    steps: NDArray[np.int64],
    level: NDArray[np.int32],
    queue: NDArray[np.int64],
    count: int,
) -> None:
    """All excess one step nearer to a need after the other, farthest first."""
    for k in range(count - 1, -1, -1):
        cell = queue[k]
        for side in range(8):
            if excess[cell] <= 0:
                break
            other = cell + steps[side]
            if capacity[cell, side] > 0 and level[other] == level[cell] - 1:
                amount = min(excess[cell], np.int64(capacity[cell, side]))
                excess[cell] -= amount
                excess[other] += amount
                capacity[cell, side] -= amount
                capacity[other, (side + 4) % 8] += amount


@njit(cache=True, nogil=True)
def least_energy(differences: NDArray[np.int32], weights: NDArray[np.int32]) -> NDArray[np.uint8]:
    """Labels (h, w), 1 = object, from object's less background's energies (h, w) and weights."""
    height, width = differences.shape
    stride = width + 2
    size = (height + 2) * stride
    excess = np.zeros(size, dtype=np.int64)
    capacity = np.zeros((size, 8), dtype=np.int32)
    for i in range(height):
        for j in range(width):
            excess[(i + 1) * stride + j + 1] = differences[i, j]
    _capacities(weights, stride, capacity)
    steps = np.zeros(8, dtype=np.int64)
    for k in range(4):
        steps[k] = PAIRS[k][0] * stride + PAIRS[k][1]
        steps[k + 4] = -steps[k]
    level, queue = np.empty(size, dtype=np.int32), np.empty(size, dtype=np.int64)
    count, flows = _levels(excess, capacity, steps, level, queue)
    while flows:
        _wave(excess, capacity, steps, level, queue, count)
        count, flows = _levels(excess, capacity, steps, level, queue)
    labels = np.zeros((height, width), dtype=np.uint8)
    for i in range(height):
        for j in range(width):
            labels[i, j] = level[(i + 1) * stride + j + 1] != _UNSEEN
    return labels
