"""ALMotion on the simulated body. Signatures and rules: `naoqi_api.yaml`, ALMotion.

Only the head turns when told; the other joints are the walk's. The simulated body does not crouch:
resting it stands with limp motors.
"""

from __future__ import annotations

from typing import Any

import qi

from hal.errors import HalError
from hal.nao.joints import JOINT_INDEX, JOINT_NAMES, JOINTS, LOWER_RAD, UPPER_RAD
from hal.types import HeadAngles, PlanarMotion
from sim_backend.speak.naoqi_robot import PeerRobot, joint_indices

WAKE_S = 0.6
LONG_S = 3600.0
TICK_S = 0.01
MAX_VELOCITY = (0.095, 0.062, 0.59)


@qi.multiThreaded()
class Motion:
    """ALMotion. qi calls it from many threads."""

    def __init__(self, robot: PeerRobot) -> None:
        self._robot = robot
        self._walk = robot.sim.walk
        self._order = 0
        self._enabled: dict[str, bool] = {"breath": True, "idle": True}

    def getBodyNames(self, name: str) -> list[str]:
        """Joints of a chain."""
        return [JOINT_NAMES[n] for n in joint_indices(name)]

    def getLimits(self, name: str) -> list[list[float]]:
        """Minimum, maximum, velocity, torque of each."""
        found = [JOINTS[n] for n in joint_indices(name)]
        return [[j.lower_rad, j.upper_rad, j.speed_max_rad_s, j.effort_max_n_m] for j in found]

    def getAngles(self, names: object, use_sensors: bool) -> list[float]:
        """Measured, or as told last, which here is the same but for the head."""
        self._robot.enter("ALMotion.getAngles")
        angles = self._robot.measured().angles_rad
        del use_sensors
        return [float(angles[n]) for n in joint_indices(names)]

    def setAngles(self, names: object, angles: object, fraction: Any) -> None:
        """The newest call wins; joints without stiffness stay."""
        self._robot.enter("ALMotion.setAngles")
        indices = joint_indices(names)
        values: list[Any] = list(angles) if isinstance(angles, list | tuple) else [angles]
        if len(values) != len(indices):
            raise ValueError(f"{len(values)} angles for {len(indices)} joints")
        if not 0.0 < float(fraction) <= 1.0:
            raise ValueError(f"fractionMaxSpeed {fraction} is not in ]0, 1]")
        told = dict(zip(indices, (float(value) for value in values), strict=True))
        yaw, pitch = JOINT_INDEX["HeadYaw"], JOINT_INDEX["HeadPitch"]
        if not {yaw, pitch} & told.keys() or self._robot.stiffness[yaw] <= 0.0:
            return
        now = self._robot.measured().angles_rad
        target = [
            min(max(told.get(n, float(now[n])), float(LOWER_RAD[n])), float(UPPER_RAD[n]))
            for n in (yaw, pitch)
        ]
        speed = float(fraction) * JOINTS[yaw].speed_max_rad_s
        self._robot.sim.head.look(HeadAngles(*target), speed)

    def wakeUp(self) -> bool:
        """Motors on; blocks until the robot stands."""
        self._robot.enter("ALMotion.wakeUp")
        with self._robot.blocking():
            self._robot.closing.wait(WAKE_S)
        self._robot.set_motors(True)
        return True

    def rest(self) -> None:
        """Motors off."""
        self._robot.enter("ALMotion.rest")
        self._robot.set_motors(False)

    def robotIsWakeUp(self) -> bool:
        """Whether the motors are on."""
        self._robot.enter("ALMotion.robotIsWakeUp")
        return self._robot.awake

    def getStiffnesses(self, names: object) -> list[float]:
        """Of each joint, 0 to 1."""
        self._robot.enter("ALMotion.getStiffnesses")
        return [float(self._robot.stiffness[n]) for n in joint_indices(names)]

    def setStiffnesses(self, names: object, values: object) -> None:
        """At once."""
        indices = joint_indices(names)
        listed = values if isinstance(values, list | tuple) else [values] * len(indices)
        for n, value in zip(indices, listed, strict=True):
            self._robot.stiffness[n] = min(max(float(value), 0.0), 1.0)

    def stiffnessInterpolation(self, names: object, values: object, times: Any) -> None:
        """Blocks while it ramps; here it jumps at the end."""
        with self._robot.blocking():
            self._robot.closing.wait(float(times))
        self.setStiffnesses(names, values)

    def moveInit(self) -> None:
        """The posture of the walk, which the simulated body has anyway."""
        self._robot.enter("ALMotion.moveInit")

    def moveTo(self, x: float, y: float, theta: float, *config: object) -> bool:
        """Walk by a displacement; blocks. True if it got there, False if it was interrupted."""
        self._robot.enter("ALMotion.moveTo")
        del config
        if self._robot.objection() is not None:
            return False
        with self._robot.blocking():
            return self._walked(PlanarMotion(float(x), float(y), float(theta)))

    def _walked(self, way: PlanarMotion) -> bool:
        order = self._next_order()
        self._robot.closing.wait(self._robot.told.move_begins_s)
        if order != self._order:
            return False
        try:
            self._walk.move_to(way, LONG_S)
        except HalError:
            return False
        while order == self._order and not self._robot.closing.wait(TICK_S):
            if not self._walk.status().moving:
                return order == self._order and self._robot.has_contact
        return False

    def move(self, x: float, y: float, theta: float, *config: object) -> None:
        """Walk at a velocity until told otherwise."""
        self._robot.enter("ALMotion.move")
        del config
        if self._robot.objection() is not None:
            return
        self._next_order()
        self._walk.set_velocity(PlanarMotion(float(x), float(y), float(theta)), LONG_S)

    def moveToward(self, x: float, y: float, theta: float, *config: object) -> None:
        """As `move`, in shares of the greatest velocity."""
        shares = [min(max(float(value), -1.0), 1.0) for value in (x, y, theta)]
        velocity = (share * top for share, top in zip(shares, MAX_VELOCITY, strict=True))
        self.move(*velocity, *config)

    def stopMove(self) -> bool:
        """Ends on both feet; blocks until it does."""
        self._robot.enter("ALMotion.stopMove")
        self._next_order()
        self._walk.stop()
        with self._robot.blocking():
            while self._walk.status().moving and not self._robot.closing.wait(TICK_S):
                pass
        return True

    def moveIsActive(self) -> bool:
        """Whether it walks."""
        self._robot.enter("ALMotion.moveIsActive")
        return self._walk.status().moving

    def getRobotPosition(self, use_sensors: bool) -> list[float]:
        """x, y, theta in FRAME_WORLD: odometry."""
        self._robot.enter("ALMotion.getRobotPosition")
        del use_sensors
        odometry = self._walk.status().odometry
        return [odometry.x, odometry.y, odometry.yaw]

    def getRobotVelocity(self) -> list[float]:
        """What it is told, m/s and rad/s."""
        velocity = self._walk.status().velocity
        return [velocity.x, velocity.y, velocity.yaw]

    def getBreathEnabled(self, chain: str) -> bool:
        """Whether it breathes."""
        del chain
        return self._enabled["breath"]

    def setBreathEnabled(self, chain: str, on: bool) -> None:
        """Breathing on or off."""
        del chain
        self._enabled["breath"] = bool(on)

    def getIdlePostureEnabled(self, chain: str) -> bool:
        """Whether it goes back to a posture when idle."""
        del chain
        return self._enabled["idle"]

    def setIdlePostureEnabled(self, chain: str, on: bool) -> None:
        """Idle posture on or off."""
        del chain
        self._enabled["idle"] = bool(on)

    def _next_order(self) -> int:
        with self._robot.lock:
            self._order += 1
            return self._order
