"""Several looks at the object from one stance, put together by their uncertainty."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from naod.geometry.transforms import wrap
from naod.localisation.ego import EgoPose, from_cartesian

_GATE = 4.0


@dataclass(frozen=True, slots=True)
class Look:
    """One localisation, or several put together.

    Both covariances (4, 4) are of x, y, z (m) and phi (rad) in the base frame: `covariance` of what
    is new in every look, `shared` of what all looks from one stance have in common. `blur_px`: how
    far the object moved through the picture during its exposure.
    """

    stamp_ns: int
    ego: EgoPose
    covariance: NDArray[np.float64]
    shared: NDArray[np.float64] = field(default_factory=lambda: np.zeros((4, 4)))
    blur_px: float = 0.0

    @property
    def total(self) -> NDArray[np.float64]:
        """(4, 4) covariance of everything that may be wrong."""
        return self.covariance + self.shared

    @property
    def sigma_m(self) -> float:
        """Standard deviation of the place on the floor, along its worst direction."""
        return float(np.sqrt(np.linalg.eigvalsh(self.total[:2, :2])[-1]))


def combine(looks: Sequence[Look]) -> Look:
    """Information-weighted mean of looks that agree with their median.

    What the looks share moves none of them against another, so it has no say in the weights and
    does not shrink with their number. A look further than four of its sigmas (or 2 cm, for tiny
    ones) from the median is left out. Raises ValueError when there is none.
    """
    if not looks:
        raise ValueError("no looks to combine")
    reference = looks[0].ego.phi_rad
    points = np.array([_point(look, reference) for look in looks])
    middle = np.median(points, axis=0)
    kept = [i for i, look in enumerate(looks) if _agrees(points[i], middle, look)]
    kept = kept or [int(np.argmin(np.linalg.norm(points[:, :2] - middle[:2], axis=1)))]
    inverses = [np.linalg.inv(looks[i].covariance) for i in kept]
    covariance: NDArray[np.float64] = np.asarray(np.linalg.inv(sum(inverses)), dtype=np.float64)
    weights = [covariance @ inverse for inverse in inverses]
    x, y, z, phi = sum(W @ points[i] for W, i in zip(weights, kept, strict=True))
    ego = from_cartesian(float(x), float(y), float(z), reference + float(phi))
    shares = [float(np.trace(W)) / 4.0 for W in weights]
    shared = sum(w * looks[i].shared for w, i in zip(shares, kept, strict=True))
    blur_px = sum(w * looks[i].blur_px for w, i in zip(shares, kept, strict=True))
    return Look(looks[-1].stamp_ns, ego, covariance, np.asarray(shared), float(blur_px))


def _point(look: Look, reference: float) -> NDArray[np.float64]:
    ego = look.ego
    return np.array([ego.x_m, ego.y_m, ego.z_m, wrap(ego.phi_rad - reference)])


def _agrees(point: NDArray[np.float64], middle: NDArray[np.float64], look: Look) -> bool:
    distance = float(np.hypot(*(point[:2] - middle[:2])))
    sigma_m = float(np.sqrt(np.linalg.eigvalsh(look.covariance[:2, :2])[-1]))
    return distance <= max(_GATE * sigma_m, 0.02)
