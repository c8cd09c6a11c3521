"""What a pose estimator says."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Estimator = Literal["exact", "paper"]


@dataclass(frozen=True, slots=True)
class ObjectPose:
    """The object in the camera's frame, with its uncertainty.

    T_camera_object: (4, 4). covariance: (6, 6) of (translation in m, rotation vector in rad), both
    along the camera's axes, the rotation about the object's origin. corners_px: (4, 2), top left,
    top right, bottom right, bottom left as seen. clipped: sides of the picture that cut the object.
    common: (6, 6), the part of the covariance that pictures from one place share; None if unknown.
    """

    T_camera_object: NDArray[np.float64]
    covariance: NDArray[np.float64]
    corners_px: NDArray[np.float64]
    estimator: Estimator
    clipped: tuple[str, ...] = ()
    common: NDArray[np.float64] | None = None

    @property
    def sigma_m(self) -> NDArray[np.float64]:
        """(3,) standard deviations of the position along the camera's axes."""
        return np.sqrt(np.diag(self.covariance)[:3])

    @property
    def sigma_rad(self) -> float:
        """Standard deviation of the rotation that is seen, root of the summed variances."""
        return float(np.sqrt(np.diag(self.covariance)[3:].sum()))
