"""Autonomous Life and its helpers, which would move the robot beside us: off, and put back.

Source: `naoqi_api.yaml`, ALAutonomousLife, also_interfering.
"""

from __future__ import annotations

import logging
from dataclasses import dataclass
from typing import Any

from hal.naoqi.errors import CallRefusedError, NoAnswerError, ServiceMissingError
from hal.naoqi.keepsake import forget, keep, kept
from hal.naoqi.session import Session

log = logging.getLogger(__name__)

LIFE = "ALAutonomousLife"
OFF = "disabled"
LIFE_S = 15.0
"""Switching it off ends activities, which takes a while."""


@dataclass(frozen=True, slots=True)
class Helper:
    """Something that moves the robot by itself: how to ask whether it is on, and how to set it."""

    service: str
    getter: str
    setter: str
    chain: tuple[str, ...] = ()

    @property
    def key(self) -> str:
        """Its name among what is kept."""
        return f"{self.service}.{self.setter}"


HELPERS: tuple[Helper, ...] = (
    Helper("ALBasicAwareness", "isEnabled", "setEnabled"),
    Helper("ALBackgroundMovement", "isEnabled", "setEnabled"),
    Helper("ALAutonomousBlinking", "isEnabled", "setEnabled"),
    Helper("ALMotion", "getBreathEnabled", "setBreathEnabled", ("Body",)),
    Helper("ALMotion", "getIdlePostureEnabled", "setIdlePostureEnabled", ("Body",)),
)


class Household:
    """Switches them off and puts them back."""

    def __init__(self, name: str) -> None:
        self._key = f"naod/{name}/life"
        self._before: dict[str, Any] = {}

    def take_over(self, session: Session) -> None:
        """Everything off; what there was is kept. Raises NotConnectedError."""
        before: dict[str, Any] = {"life": _life(session)}
        # a life before this one had switched off what it did not put back
        old = kept(session, self._key) or {}
        for helper in HELPERS:
            before[helper.key] = _is_on(session, helper)
        before = {**before, **{key: value for key, value in old.items() if key in before}}
        keep(session, self._key, before)
        self._before = before
        if _life(session) not in (None, OFF):
            _attempt(session, LIFE, "setState", OFF)
        for helper in HELPERS:
            if _is_on(session, helper):
                _attempt(session, helper.service, helper.setter, *helper.chain, False)

    def give_back(self, session: Session) -> None:
        """As it was before. Raises NotConnectedError."""
        for helper in HELPERS:
            if self._before.get(helper.key) is True:
                _attempt(session, helper.service, helper.setter, *helper.chain, True)
        life = self._before.get("life")
        if isinstance(life, str) and life != OFF:
            _attempt(session, LIFE, "setState", life)
        if self._before:
            forget(session, self._key)
        self._before = {}


def _life(session: Session) -> str | None:
    try:
        state = session.call(LIFE, "getState")
    except (ServiceMissingError, CallRefusedError):
        return None
    return state if isinstance(state, str) else None


def _is_on(session: Session, helper: Helper) -> bool | None:
    """None when the robot has no such thing, or does not say."""
    try:
        if not session.has(helper.service, helper.setter):
            return None
        return bool(session.call(helper.service, helper.getter, *helper.chain))
    except (ServiceMissingError, CallRefusedError):
        return None


def _attempt(session: Session, service: str, method: str, *args: object) -> None:
    try:
        session.call(service, method, *args, timeout_s=LIFE_S)
    except (ServiceMissingError, CallRefusedError, NoAnswerError) as error:
        log.warning("%s", error)
