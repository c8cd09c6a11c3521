"""Vectors of three in kernels, without a library call: a robot has no scipy for numba's."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True)
def unit(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """A vector (3,) of length 1."""
    return x / max(math.sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]), 1e-12)


@njit(cache=True, nogil=True)
def cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of two vectors (3,)."""
    out = np.empty(3)
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]
    return out


@njit(cache=True, nogil=True)
def dot(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Of two vectors (3,)."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
