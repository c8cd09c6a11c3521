"""What a simulated robot offers beyond a real one: truth, and time that can be stepped."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from hal.protocols import Robot
from hal.scenario import Scenario
from hal.types import PlanarMotion


@dataclass(frozen=True, slots=True)
class Truth:
    """Where things really are at `stamp_ns`, in the world (z up, floor at 0).

    `base`: the frame between the feet. `T_world_object` and `T_world_camera`: (4, 4); the object's
    axes are x to the right and y up along it, z out of its face; a cylinder's z is horizontal
    towards the camera. The camera's are x right, y down, z forward.
    """

    stamp_ns: int
    base: PlanarMotion
    T_world_object: NDArray[np.float64]
    T_world_camera: NDArray[np.float64]


@runtime_checkable
class SimulatedRobot(Robot, Protocol):
    """A robot in a simulated world."""

    @property
    def scenario(self) -> Scenario:
        """The world it stands in."""
        ...

    def truth(self) -> Truth:
        """The present truth."""
        ...

    def place(self, pose: PlanarMotion) -> None:
        """Put the robot somewhere, standing still, head straight, as a person would carry it."""
        ...

    def advance(self, until_ns: int) -> None:
        """Let the world run until then (lock-step only)."""
        ...

    def room_view(self, width: int, height: int) -> NDArray[np.uint8]:
        """The scene from a fixed place in the room, (height, width, 3) uint8 RGB."""
        ...


class Studio(Protocol):
    """Pictures and exact masks of a simulated scene from any camera pose, without a robot.

    Poses are T_world_camera (4, 4), optical axes. `exposure_poses` (n, 4, 4): where the camera is
    at equal times from the exposure's begin to its end, in place of the one pose.
    """

    @property
    def T_world_object(self) -> NDArray[np.float64]:
        """Where the object is, axes as in `Truth`."""
        ...

    def frame_at(
        self,
        T_world_camera: NDArray[np.float64],
        exposure_poses: NDArray[np.float64] | None = None,
        noise_seed: int | None = None,
    ) -> NDArray[np.uint8]:
        """YUYV (height, width, 2) uint8, with the scenario's sensor noise if seeded."""
        ...

    def frame_before(
        self,
        backdrop: NDArray[np.float32],
        T_world_camera: NDArray[np.float64],
        exposure_poses: NDArray[np.float64] | None = None,
        noise_seed: int | None = None,
    ) -> NDArray[np.uint8]:
        """As `frame_at`, the object alone before a picture in place of its room.

        backdrop: (height, width, 3) float32 linear light, 1 is full. Raises ValueError for another
        size.
        """
        ...

    def mask_at(
        self,
        T_world_camera: NDArray[np.float64],
        exposure_poses: NDArray[np.float64] | None = None,
    ) -> NDArray[np.uint8]:
        """255 where at least half of a pixel, and of the exposure, shows the object, else 0."""
        ...
