"""Small symmetric systems without a library call: a robot has no scipy for numba's."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True)
def solve_symmetric(A: NDArray[np.float64], b: NDArray[np.float64], x: NDArray[np.float64]) -> bool:
    """Solve A x = b by Cholesky; False where A is not positive definite.

    A (n, n) is destroyed. x (n,) may be b itself.
    """
    n = b.size
    for i in range(n):
        for j in range(i + 1):
            total = A[i, j]
            for k in range(j):
                total -= A[i, k] * A[j, k]
            if i == j:
                if not total > 0.0:
                    return False
                A[i, i] = math.sqrt(total)
            else:
                A[i, j] = total / A[j, j]
    for i in range(n):
        total = b[i]
        for k in range(i):
            total -= A[i, k] * x[k]
        x[i] = total / A[i, i]
    for i in range(n - 1, -1, -1):
        total = x[i]
        for k in range(i + 1, n):
            total -= A[k, i] * x[k]
        x[i] = total / A[i, i]
    return True


@njit(cache=True, nogil=True)
def invert_symmetric(A: NDArray[np.float64], inverse: NDArray[np.float64]) -> bool:
    """Inverse (n, n) of a symmetric A (n, n), which is destroyed.

    By Gauss and Jordan, in place and without pivots. False where A is not positive definite.
    """
    n = A.shape[0]
    for k in range(n):
        pivot = A[k, k]
        if not pivot > 0.0:
            return False
        A[k, k] = 1.0
        for j in range(n):
            A[k, j] /= pivot
        for i in range(n):
            if i != k:
                factor = A[i, k]
                A[i, k] = 0.0
                for j in range(n):
                    A[i, j] -= factor * A[k, j]
    for i in range(n):
        for j in range(n):
            inverse[i, j] = 0.5 * (A[i, j] + A[j, i])
    return True
