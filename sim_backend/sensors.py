"""What the body's sensors report: encoders, inertial unit, foot pressure, battery, temperature."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hal.nao.feet import FSR_IN_ANKLE_M
from hal.nao.joints import ENCODER_STEP_RAD
from hal.types import BodyState, NaoVersion
from sim_backend.figures import standing_com_x_m, total_mass_kg
from sim_backend.motions import GRAVITY_M_S2
from sim_backend.poses import Matrix
from sim_backend.snapshot import Snapshot
from sim_backend.streams import Purpose, stream

ANGLE_STD_RAD = 0.0004
GYRO_STD_RAD_S = 0.006
ACCEL_STD_M_S2 = 0.06
TILT_STD_RAD = 0.002
FSR_STD_KG = 0.01
FSR_MAX_KG = 25.0 / GRAVITY_M_S2
BATTERY_START, BATTERY_PER_S = 0.92, 0.92 / 4800.0
"""About 80 minutes of activity from a full charge."""
WARM_START_C, WARM_END_C, WARM_TAU_S = 38.0, 62.0, 900.0


class Sensors:
    """Turns true states, one after another, into measurements. Needs them at equal steps."""

    def __init__(self, seed: int, version: NaoVersion, dt: float) -> None:
        self._rng = stream(seed, Purpose.SENSORS)
        self._dt = dt
        self._shares = (_fsr_shares("l_ankle", version), _fsr_shares("r_ankle", version))
        self._mass_kg = total_mass_kg(version)
        self._before: Matrix | None = None
        self._velocity: NDArray[np.float64] = np.zeros(3)
        self._time_s = 0.0

    def forget(self) -> None:
        """The robot has been carried: what comes next is not a motion of its own."""
        self._before = None

    def measure(self, stamp_ns: int, now: Snapshot) -> BodyState:
        """The measurement of a state, a step after the one before."""
        self._time_s += self._dt
        gyro, accel = self._inertial(now.T_world_torso)
        R = now.T_world_torso[:3, :3]
        tilt = np.array([math.atan2(R[2, 1], R[2, 2]), math.asin(max(-1.0, min(1.0, -R[2, 0])))])
        rng = self._rng
        angles = now.angles_rad + ANGLE_STD_RAD * rng.standard_normal(26)
        warm = 1.0 - math.exp(-self._time_s / WARM_TAU_S)
        return BodyState(
            stamp_ns=stamp_ns,
            # adding zero keeps a joint at rest from reading -0.0
            angles_rad=np.rint(angles / ENCODER_STEP_RAD) * ENCODER_STEP_RAD + 0.0,
            gyro_rad_s=gyro + GYRO_STD_RAD_S * rng.standard_normal(3),
            accel_m_s2=accel + ACCEL_STD_M_S2 * rng.standard_normal(3),
            torso_roll_pitch_rad=tilt + TILT_STD_RAD * rng.standard_normal(2),
            fsr_kg=self._fsr(now.loads),
            battery=max(0.0, BATTERY_START - BATTERY_PER_S * self._time_s),
            temperature_max_c=WARM_START_C + (WARM_END_C - WARM_START_C) * warm,
        )

    def _inertial(self, T: Matrix) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        before = T if self._before is None else self._before
        velocity = (T[:3, 3] - before[:3, 3]) / self._dt
        change = np.zeros(3) if self._before is None else (velocity - self._velocity) / self._dt
        self._before, self._velocity = T, velocity
        turn = before[:3, :3].T @ T[:3, :3]
        gyro = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
        upwards = change + np.array([0.0, 0.0, GRAVITY_M_S2])
        return gyro / (2.0 * self._dt), T[:3, :3].T @ upwards

    def _fsr(self, loads: tuple[float, float]) -> NDArray[np.float64]:
        shares = np.concatenate(
            [load * cells for load, cells in zip(loads, self._shares, strict=True)]
        )
        noise = FSR_STD_KG * self._rng.standard_normal(8)
        return np.clip(self._mass_kg * shares + noise, 0.0, FSR_MAX_KG)


def _fsr_shares(ankle: str, version: NaoVersion) -> NDArray[np.float64]:
    """Each cell's share of a foot's load, (4,): the centre of pressure lies below that of mass."""
    cells = FSR_IN_ANKLE_M[ankle]
    front, rear = cells[0][0], 0.5 * (cells[2][0] + cells[3][0])
    forward = (standing_com_x_m(version) - rear) / (front - rear)
    shares = []
    for n, row in enumerate((forward, 1.0 - forward)):
        left, right = cells[2 * n][1], cells[2 * n + 1][1]
        shares += [row * -right / (left - right), row * left / (left - right)]
    return np.array(shares)
