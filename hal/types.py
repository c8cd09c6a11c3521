"""Values that cross the hardware abstraction layer; each says when it was true.

All stamps are nanoseconds of the robot's one monotonic clock. Angles are radians, lengths metres.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

NaoVersion = Literal["v5", "v6"]
CameraName = Literal["top", "bottom"]


@dataclass(frozen=True, slots=True)
class Frame:
    """A picture as the camera gives it.

    `yuyv` has shape (height, width, 2), uint8: [..., 0] is Y, [..., 1] is U on even columns and V
    on odd ones. `stamp_ns` is the middle of the exposure.
    """

    stamp_ns: int
    yuyv: NDArray[np.uint8]
    camera: CameraName
    exposure_s: float
    sequence: int

    @property
    def width(self) -> int:
        """Columns in pixels."""
        return int(self.yuyv.shape[1])

    @property
    def height(self) -> int:
        """Rows in pixels."""
        return int(self.yuyv.shape[0])


@dataclass(frozen=True, slots=True)
class BodyState:
    """Measured state of the body at `stamp_ns`.

    `angles_rad`: (26,), order of `hal.nao.joints.JOINT_NAMES`. `gyro_rad_s` and `accel_m_s2`: (3,),
    torso axes, +9.81 on z when standing. `torso_roll_pitch_rad`: (2,). `fsr_kg`: (8,), left foot
    front-left, front-right, rear-left, rear-right, then the right foot. `battery`: 0 to 1.
    """

    stamp_ns: int
    angles_rad: NDArray[np.float64]
    gyro_rad_s: NDArray[np.float64]
    accel_m_s2: NDArray[np.float64]
    torso_roll_pitch_rad: NDArray[np.float64]
    fsr_kg: NDArray[np.float64]
    battery: float
    temperature_max_c: float

    @property
    def foot_load_kg(self) -> tuple[float, float]:
        """Weight on the left and on the right foot."""
        return float(self.fsr_kg[:4].sum()), float(self.fsr_kg[4:].sum())


@dataclass(frozen=True, slots=True)
class HeadAngles:
    """Angles of the head's two joints."""

    yaw_rad: float
    pitch_rad: float


@dataclass(frozen=True, slots=True)
class PlanarMotion:
    """A displacement (m, m, rad) or a velocity (m/s, m/s, rad/s) of the base frame."""

    x: float
    y: float
    yaw: float


@dataclass(frozen=True, slots=True)
class WalkStatus:
    """What the walk primitive does at `stamp_ns`.

    `velocity` is what it is told to do, zero when it has been told to stop; `moving` stays true
    until both feet stand. `odometry` is the pose of the base since start-up: x, y in m, yaw in rad.
    """

    stamp_ns: int
    moving: bool
    fallen: bool
    velocity: PlanarMotion
    odometry: PlanarMotion


@dataclass(frozen=True, slots=True)
class RobotInfo:
    """Which robot this is."""

    name: str
    version: NaoVersion
    backend: str
    simulated: bool
