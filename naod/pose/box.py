"""What an outline looks like at a glance: an oriented box on the plane z = 1."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Box:
    """Four corners (4, 2) on the plane z = 1: top left, top right, bottom right, bottom left.

    `cut`: (4,) whether the top, right, bottom, left edge is the picture's border instead.
    """

    corners: NDArray[np.float64]
    cut: NDArray[np.bool_]

    def turned(self) -> Box:
        """The same box with its right edge on top."""
        return Box(np.roll(self.corners, -1, axis=0), np.roll(self.cut, -1))

    @property
    def across(self) -> float:
        """Mean length of the top and bottom edges."""
        a, b, c, d = self.corners
        return float(np.linalg.norm(b - a) + np.linalg.norm(c - d)) / 2.0

    @property
    def along(self) -> float:
        """Mean length of the left and right edges."""
        return self.turned().across

    @property
    def up(self) -> NDArray[np.float64]:
        """(2,) unit vector from the bottom edge to the top one."""
        d = self.corners[:2].sum(axis=0) - self.corners[2:].sum(axis=0)
        return d / np.linalg.norm(d)

    def centre(self, across: float, along: float) -> NDArray[np.float64]:
        """(2,) middle of the object were it `across` wide and `along` high: held by whole edges."""
        up, right = self.up, self.turned().up
        middle = np.asarray(self.corners.mean(axis=0), dtype=np.float64)
        lack_along, lack_across = (along - self.along) / 2.0, (across - self.across) / 2.0
        middle = middle + up * (lack_along * (int(self.cut[0]) - int(self.cut[2])))
        return middle + right * lack_across * (int(self.cut[1]) - int(self.cut[3]))


def line_through(points: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """(3,) a, b, c with a x + b y + c = 0 and a^2 + b^2 = 1, least squares across the line.

    None for fewer than two points (n, 2).
    """
    if len(points) < 2:
        return None
    mean = points.mean(axis=0)
    x, y = (points - mean).T
    angle = 0.5 * math.atan2(2.0 * float(x @ y), float(x @ x - y @ y))
    normal = np.array([-math.sin(angle), math.cos(angle)])
    return np.append(normal, -normal @ mean)
