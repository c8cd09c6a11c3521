"""Where the object is expected before a picture is looked at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Prior:
    """Where the object was last seen, carried into the present camera by head and odometry.

    `T_camera_object`: (4, 4). `covariance`: (6, 6) of translation (m) and rotation (rad) about the
    object's origin, camera axes, grown by what has moved since. `age_s`: since it was seen.
    """

    T_camera_object: NDArray[np.float64]
    covariance: NDArray[np.float64]
    age_s: float
