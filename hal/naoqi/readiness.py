"""Whether the robot could walk now, and why not. Sources: `naoqi_api.yaml`, walk_refused_when."""

from __future__ import annotations

from dataclasses import dataclass

from hal.naoqi.errors import CallRefusedError, ServiceMissingError
from hal.naoqi.ids import LEG_JOINTS, STIFFNESS_MIN, UPRIGHT_FAMILIES
from hal.naoqi.memory import Sensed
from hal.naoqi.session import Session


@dataclass(frozen=True, slots=True)
class Readiness:
    """What matters for walking; None where the robot does not say."""

    awake: bool | None = None
    leg_stiffness: float | None = None
    head_stiffness: float | None = None
    family: str | None = None


def read_readiness(session: Session) -> Readiness:
    """Ask the robot. Raises NotConnectedError or NoAnswerError."""
    awake = _asked(session, "ALMotion", "robotIsWakeUp")
    legs = _asked(session, "ALMotion", "getStiffnesses", list(LEG_JOINTS))
    head = _asked(session, "ALMotion", "getStiffnesses", ["HeadYaw", "HeadPitch"])
    family = _asked(session, "ALRobotPosture", "getPostureFamily")
    return Readiness(
        awake=awake if isinstance(awake, bool) else None,
        leg_stiffness=_least(legs),
        head_stiffness=_least(head),
        family=family if isinstance(family, str) else None,
    )


def objection(memory: Sensed) -> str | None:
    """What speaks against walking, and standing up would not help."""
    if memory.lies:
        return "the robot has fallen"
    if memory.hangs:
        return "the robot has been lifted: no foot touches the floor"
    return None


def needs_rising(ready: Readiness) -> str | None:
    """Why it would have to stand up first; None if it stands ready."""
    if ready.awake is False:
        return "the robot is resting"
    if ready.leg_stiffness is not None and ready.leg_stiffness <= STIFFNESS_MIN:
        return (
            f"stiffness of the legs is {ready.leg_stiffness:.2g}, "
            f"NAOqi walks only above {STIFFNESS_MIN:g}"
        )
    if ready.family is not None and ready.family not in UPRIGHT_FAMILIES:
        return f"the robot does not stand (posture: {ready.family})"
    return None


def _asked(session: Session, service: str, method: str, *args: object) -> object:
    try:
        found: object = session.call(service, method, *args)
    except (ServiceMissingError, CallRefusedError):
        return None
    return found


def _least(values: object) -> float | None:
    if not isinstance(values, list | tuple) or not values:
        return None
    if not all(isinstance(value, int | float) for value in values):
        return None
    return float(min(values))
