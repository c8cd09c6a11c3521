"""How well a backend's own loop keeps its time, measured (`naod bench lola`)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class LoopTiming:
    """Every message the robot's side sent, in order.

    `answered_s`: (n,), from when a message was sent until it was answered; infinite for one that
    never was. `deadline_s`: by when it has to be. `real_time`: whether the kernel granted it.
    """

    answered_s: NDArray[np.float64]
    deadline_s: float
    real_time: bool

    @property
    def missed(self) -> int:
        """How many were answered too late or never."""
        return int((self.answered_s > self.deadline_s).sum())
