"""The services around the motion: posture, Autonomous Life and its helpers."""

from __future__ import annotations

import qi

from sim_backend.speak.naoqi_robot import PeerRobot

LIFE_STATES = ("solitary", "interactive", "disabled", "safeguard")


@qi.multiThreaded()
class Posture:
    """ALRobotPosture: it stands, crouches with limp motors, or lies."""

    def __init__(self, robot: PeerRobot) -> None:
        self._robot = robot

    def getPostureFamily(self) -> str:
        """The family's name."""
        self._robot.enter("ALRobotPosture.getPostureFamily")
        if self._robot.fallen:
            return "LyingBelly"
        return "Standing" if self._robot.awake else "Crouching"

    def getPosture(self) -> str:
        """The posture's name."""
        names = {"LyingBelly": "LyingBelly", "Standing": "StandInit", "Crouching": "Crouch"}
        return names[self.getPostureFamily()]

    def goToPosture(self, name: str, speed: float) -> bool:
        """Whether it was reached: only a robot that is awake and has not fallen gets anywhere."""
        self._robot.enter("ALRobotPosture.goToPosture")
        del speed
        return name.startswith("Stand") and self._robot.awake and not self._robot.fallen

    def stopMove(self) -> None:
        """Nothing is under way."""


@qi.multiThreaded()
class Life:
    """ALAutonomousLife."""

    def __init__(self, robot: PeerRobot) -> None:
        self._robot = robot

    def getState(self) -> str:
        """Its state."""
        self._robot.enter("ALAutonomousLife.getState")
        return self._robot.life

    def setState(self, state: str) -> None:
        """Raises RuntimeError for a state there is not."""
        self._robot.enter("ALAutonomousLife.setState")
        if state not in LIFE_STATES:
            raise RuntimeError(f"ALAutonomousLife: invalid state {state}")
        self._robot.life = state


@qi.multiThreaded()
class System:
    """ALSystem: only its version, which is the one that `naoqi_api.yaml` describes."""

    def systemVersion(self) -> str:
        """As NAOqi writes it."""
        return "2.8.5.10"


@qi.multiThreaded()
class Switch:
    """A helper that can be on or off: ALBasicAwareness and its like."""

    def __init__(self, robot: PeerRobot, name: str) -> None:
        self._robot, self._name = robot, name
        self._on = True

    def isEnabled(self) -> bool:
        """Whether it is on."""
        self._robot.enter(f"{self._name}.isEnabled")
        return self._on

    def setEnabled(self, on: bool) -> None:
        """On or off."""
        self._robot.enter(f"{self._name}.setEnabled")
        self._on = bool(on)
