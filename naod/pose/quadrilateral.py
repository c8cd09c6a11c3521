"""Four corners of a convex outline."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

ROUNDS = 3


@njit(cache=True, nogil=True)
def _farthest(points: NDArray[np.float64], dx: float, dy: float) -> int:
    best, at = -np.inf, 0
    for k in range(points.shape[0]):
        reach = dx * points[k, 0] + dy * points[k, 1]
        if reach > best:
            best, at = reach, k
    return at


@njit(cache=True, nogil=True)
def quadrilateral(
    points: NDArray[np.float64], box: NDArray[np.float64], corners: NDArray[np.float64]
) -> bool:
    """Corners (4, 2) of points (n, 2) about a quadrilateral, in the order of their box's (4, 2).

    Of the points the four with the most area between them: each in turn is put as far as may be
    from the line of its neighbours. False where that is no quadrilateral.
    """
    x, y = box[:, 0].mean(), box[:, 1].mean()
    for k in range(4):
        corners[k] = points[_farthest(points, box[k, 0] - x, box[k, 1] - y)]
    for _ in range(ROUNDS):
        for k in range(4):
            a, b = corners[(k + 3) % 4], corners[(k + 1) % 4]
            corners[k] = points[_farthest(points, b[1] - a[1], a[0] - b[0])]
    least, most = np.inf, 0.0
    for k in range(4):
        a, b, c = corners[k], corners[(k + 1) % 4], corners[(k + 2) % 4]
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        least, most = min(least, area), max(most, area)
    # a triangle has nothing to speak of on one side
    return least > 0.1 * most
