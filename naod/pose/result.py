"""What a pose estimator says."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Estimator = Literal["exact", "paper"]
EDGES = ("top", "right", "bottom", "left")


@dataclass(frozen=True, slots=True)
class ObjectPose:
    """The object in the camera's frame, with its uncertainty.

    T_camera_object: (4, 4). covariance: (6, 6) of (translation in m, rotation vector in rad), both
    along the camera's axes, the rotation about the object's origin. corners_px: (4, 2), top left,
    top right, bottom right, bottom left as seen. clipped: sides of the picture that cut the object.
    edges_seen: those of EDGES of which at least half was found. blur_px: width of the motion blur
    as the edges show it, 0 where they are sharp. support: share of the outline that was found.
    """

    T_camera_object: NDArray[np.float64]
    covariance: NDArray[np.float64]
    corners_px: NDArray[np.float64]
    estimator: Estimator
    clipped: tuple[str, ...] = ()
    edges_seen: tuple[str, ...] = EDGES
    blur_px: float = 0.0
    support: float = 1.0

    @property
    def sigma_m(self) -> NDArray[np.float64]:
        """(3,) standard deviations of the position along the camera's axes."""
        return np.sqrt(np.diag(self.covariance)[:3])

    @property
    def sigma_rad(self) -> float:
        """Standard deviation of the rotation that is seen, root of the summed variances."""
        return float(np.sqrt(np.diag(self.covariance)[3:].sum()))
