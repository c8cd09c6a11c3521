"""The simulated body driven by its joints alone: 25 targets and stiffnesses, as LoLA has them.

It is a posture, not dynamics: joints follow their targets with a servo's lag and speed, and the
robot is put on the floor as its legs stand. There are two ways it can come to harm all the same: it
falls when its legs lose their stiffness while it stands high, and it shows when it is knocked over.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from hal.nao.feet import SOLE_IN_ANKLE_M
from hal.nao.head_limits import HEAD_SPEED_MAX_RAD_S
from hal.nao.joints import JOINT_INDEX, JOINT_NAMES, JOINTS, LOWER_RAD, UPPER_RAD
from hal.scenario import Scenario
from hal.types import NaoVersion
from sim_backend.figures import links_in_torso
from sim_backend.head import LAG_S
from sim_backend.poses import Matrix, inverse, moved, planar, transform
from sim_backend.snapshot import Snapshot
from sim_backend.walk_model import Bearing
from sim_backend.world import TICK_NS, World

Array = NDArray[np.float64]

HELD_FROM = 0.1
"""Stiffness below which a leg does not carry; an assumption."""

HIGH_M = 0.26
"""Torso above the soles from where an unheld robot falls: 0.23 seated, 0.32 standing."""

_LEG = ("HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")
_LEGS = np.array([i for i, name in enumerate(JOINT_NAMES) if name[1:] in _LEG])
_KNEES = np.array([JOINT_INDEX["LKneePitch"], JOINT_INDEX["RKneePitch"]])
_SPEEDS = np.array([joint.speed_max_rad_s for joint in JOINTS])
_SPEEDS[:2] = HEAD_SPEED_MAX_RAD_S


class Servos:
    """26 joints that follow targets as far as they are stiff. Holds no clock."""

    def __init__(self, angles_rad: Array) -> None:
        self.angles_rad = angles_rad.copy()
        self.stiffness: Array = np.zeros(26)
        self._set_point = angles_rad.copy()
        self._target: Array = angles_rad.copy()

    def drive(self, target_rad: Array | None, stiffness: Array | None) -> None:
        """New targets and stiffness, (26,) each; None leaves them as they are."""
        if target_rad is not None:
            self._target = np.clip(target_rad, LOWER_RAD, UPPER_RAD)
        if stiffness is not None:
            self.stiffness = np.clip(stiffness, -1.0, 1.0)

    def run(self, dt: float) -> None:
        """Move on by `dt` seconds; a joint that is not stiff stays where it is."""
        held = self.stiffness > 0.0
        most = np.where(held, _SPEEDS * dt, 0.0)
        self._set_point = np.where(held, self._set_point, self.angles_rad)
        self._set_point += np.clip(self._target - self._set_point, -most, most)
        share = 1.0 - math.exp(-dt / LAG_S)
        self.angles_rad = self.angles_rad + share * (self._set_point - self.angles_rad)


def torso_over_soles(angles_rad: Array) -> tuple[Matrix, tuple[float, float]]:
    """T_base_torso (4, 4) of a robot on its soles, and each foot's share of the weight."""
    frames = links_in_torso(angles_rad)
    left, right = (frames[ankle] @ moved(*SOLE_IN_ANKLE_M) for ankle in ("l_ankle", "r_ankle"))
    z = left[:3, 2] + right[:3, 2]
    z /= np.linalg.norm(z)
    x = left[:3, 0] + right[:3, 0]
    x -= (x @ z) * z
    x /= np.linalg.norm(x)
    apart = float((left[:3, 3] - right[:3, 3]) @ z)
    middle = 0.5 * (left[:3, 3] + right[:3, 3]) - 0.5 * abs(apart) * z
    T_torso_base = transform(np.stack([x, np.cross(z, x), z], axis=1), middle)
    # a foot half a centimetre above the other carries nothing
    share = min(max(0.5 - apart / 0.010, 0.0), 1.0)
    return inverse(T_torso_base), (share, 1.0 - share)


class JointWorld(World):
    """A world whose robot neither walks nor looks by itself."""

    def __init__(
        self,
        scenario: Scenario,
        version: NaoVersion,
        seed: int,
        real_ns: Callable[[], int] | None,
        angles_rad: Array,
    ) -> None:
        """`angles_rad`: (26,), as it stands or sits at first, held by somebody."""
        self._servos = Servos(angles_rad)
        self._posed = angles_rad.copy()
        self._T_base_torso, self._loads = torso_over_soles(angles_rad)
        self._was_held = False
        super().__init__(scenario, version, seed, real_ns)

    @property
    def stiffness(self) -> Array:
        """(26,), as it is now."""
        return self._servos.stiffness

    @property
    def fallen(self) -> bool:
        """Whether it lies."""
        return self._model.fallen

    @property
    def angles_rad(self) -> Array:
        """(26,), the true ones."""
        return self._servos.angles_rad

    def summary(self) -> str:
        """How it is, in a few words."""
        with self.lock:
            if self._model.fallen:
                return "has fallen"
            posed = "stands" if self._T_base_torso[2, 3] > HIGH_M else "sits"
            stiff = bool((self._servos.stiffness > 0.0).any())
            return f"{posed}, its joints {'stiff' if stiff else 'free'}"

    def drive(self, target_rad: Array | None, stiffness: Array | None) -> None:
        """What the joints are to do from now on, (26,) each, or None for as before."""
        with self.lock:
            self._servos.drive(target_rad, stiffness)

    def _record(self, bearing: Bearing) -> None:
        self._servos.run(TICK_NS / 1e9)
        angles = self._servos.angles_rad
        if float(np.abs(angles - self._posed)[_LEGS].max()) > 1e-6:
            self._posed = angles.copy()
            self._T_base_torso, self._loads = torso_over_soles(angles)
        self._fall_if_unheld()
        T_world_torso, loads = planar(bearing.base) @ self._T_base_torso, self._loads
        if self._model.fallen:
            T_world_torso, loads = bearing.T_world_torso, (0.0, 0.0)
        now = Snapshot(T_world_torso, angles.copy(), bearing.base, bearing.odometry, loads)
        self._past.append(self._tick_ns, now)
        self._measured.append(self._tick_ns, self._sensors.measure(self._tick_ns, now))

    def _fall_if_unheld(self) -> None:
        """Whoever propped the robot up at first has gone once it has been stiff."""
        held = bool((self._servos.stiffness[_KNEES] >= HELD_FROM).all())
        self._was_held = self._was_held or held
        if self._was_held and not held and self._T_base_torso[2, 3] > HIGH_M:
            self._model.knock_over()
