"""Several looks at the object from one stance, put together by their uncertainty."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from naod.geometry.transforms import wrap
from naod.localisation.ego import EgoPose, from_cartesian

# encoder steps, sag and the mounting tilt the camera by about this much from look to look
_TILT_SIGMA_RAD = 0.003
_GATE = 4.0


@dataclass(frozen=True, slots=True)
class Look:
    """One localisation: `covariance` (4, 4) of x, y, z (m) and phi (rad) in the base frame."""

    stamp_ns: int
    ego: EgoPose
    covariance: NDArray[np.float64]

    @property
    def sigma_m(self) -> float:
        """Standard deviation of the place on the floor, along its worst direction."""
        return float(np.sqrt(np.linalg.eigvalsh(self.covariance[:2, :2])[-1]))


def with_body_error(covariance: NDArray[np.float64], ego: EgoPose) -> NDArray[np.float64]:
    """Adds what the body's own tilt contributes at the object's distance; (4, 4)."""
    lever = (_TILT_SIGMA_RAD * max(ego.rho_m, 0.1)) ** 2
    return covariance + np.diag([lever, lever, lever, _TILT_SIGMA_RAD**2])


def combine(looks: Sequence[Look]) -> Look:
    """Information-weighted mean of looks that agree with their median.

    A look further than four of its sigmas (or 2 cm, for tiny ones) from the median is left out.
    Raises ValueError when there is none.
    """
    if not looks:
        raise ValueError("no looks to combine")
    reference = looks[0].ego.phi_rad
    points = np.array([_point(look, reference) for look in looks])
    middle = np.median(points, axis=0)
    kept = [i for i, look in enumerate(looks) if _agrees(points[i], middle, look)]
    kept = kept or [int(np.argmin(np.linalg.norm(points[:, :2] - middle[:2], axis=1)))]
    information = np.zeros((4, 4))
    weighted = np.zeros(4)
    for i in kept:
        inverse = np.linalg.inv(looks[i].covariance)
        information += inverse
        weighted += inverse @ points[i]
    covariance: NDArray[np.float64] = np.asarray(np.linalg.inv(information), dtype=np.float64)
    x, y, z, phi = (float(v) for v in covariance @ weighted)
    return Look(looks[-1].stamp_ns, from_cartesian(x, y, z, reference + phi), covariance)


def _point(look: Look, reference: float) -> NDArray[np.float64]:
    ego = look.ego
    return np.array([ego.x_m, ego.y_m, ego.z_m, wrap(ego.phi_rad - reference)])


def _agrees(point: NDArray[np.float64], middle: NDArray[np.float64], look: Look) -> bool:
    distance = float(np.hypot(*(point[:2] - middle[:2])))
    return distance <= max(_GATE * look.sigma_m, 0.02)
