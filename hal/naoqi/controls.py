"""The camera's controls: locked for colour work, and put back.

Order and numbers: `nao_cameras.yaml`, lock_for_colour_segmentation. What automatic exposure and
white balance have found is frozen; a focus that can be set is set to far.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import dataclass

from hal.naoqi.errors import CallRefusedError, ServiceMissingError
from hal.naoqi.ids import NO_PARAMETER, PARAMETERS
from hal.naoqi.keepsake import forget, keep, kept
from hal.naoqi.session import Session

log = logging.getLogger(__name__)

_AUTOMATIC = ("kCameraAutoExpositionID", "kCameraAutoWhiteBalanceID", "kCameraAutoFocusID")
_LOCK_ORDER = (
    "kCameraAutoExpositionID",
    "kCameraExposureID",
    "kCameraGainID",
    "kCameraAutoWhiteBalanceID",
    "kCameraWhiteBalanceID",
    "kCameraAutoFocusID",
    "kCameraFocusID",
)
_FOCUS_FAR = 0

GIVEN: dict[str, str] = {
    "exposure": "kCameraExposureID",
    "gain": "kCameraGainID",
    "white_balance": "kCameraWhiteBalanceID",
    "focus": "kCameraFocusID",
}
"""Controls whose value may be given, and NAOqi's names of them."""


@dataclass(frozen=True, slots=True)
class Locked:
    """What was there before, by name, and which controls did not take."""

    before: dict[str, int]
    not_taken: tuple[str, ...]


def read_controls(session: Session, camera: int) -> dict[str, int]:
    """The controls this camera has, by name. Raises NotConnectedError."""
    found: dict[str, int] = {}
    for name in _LOCK_ORDER:
        try:
            value = int(session.call("ALVideoDevice", "getParameter", camera, PARAMETERS[name]))
        except (CallRefusedError, ServiceMissingError, TypeError, ValueError):
            continue
        if value != NO_PARAMETER:
            found[name] = value
    return found


def lock_controls(session: Session, camera: int, key: str, given: Mapping[str, int]) -> Locked:
    """Switch everything automatic off; hold what is given, else what it had found.

    Raises NotConnectedError.

    What a life before this one found, and did not put back, counts as what was there before.
    """
    present = read_controls(session, camera)
    before = _of_a_life_before(session, key) or present
    keep(session, key, before)
    wanted = {name: _wanted(name, value) for name, value in present.items()}
    wanted.update({GIVEN[name]: value for name, value in given.items()})
    not_taken = [
        name
        for name in _LOCK_ORDER
        if name in wanted and not _set(session, camera, name, wanted[name])
    ]
    if not_taken:
        log.warning("camera controls that did not take: %s", ", ".join(not_taken))
    return Locked(before, tuple(not_taken))


def restore_controls(session: Session, camera: int, key: str, before: dict[str, int]) -> None:
    """Put everything back: values first, then what was automatic. Raises NotConnectedError."""
    values = [name for name in _LOCK_ORDER if name not in _AUTOMATIC]
    for name in (*values, *_AUTOMATIC):
        if name in before and not _set(session, camera, name, before[name]):
            log.warning("the camera did not take %s back", name)
    forget(session, key)


def _of_a_life_before(session: Session, key: str) -> dict[str, int]:
    found = kept(session, key) or {}
    return {
        name: value for name, value in found.items() if name in PARAMETERS and type(value) is int
    }


def _wanted(name: str, present: int) -> int:
    if name in _AUTOMATIC:
        return 0
    return _FOCUS_FAR if name == "kCameraFocusID" else present


def _set(session: Session, camera: int, name: str, value: int) -> bool:
    """Whether it took: some cameras say yes and stay as they are."""
    number = PARAMETERS[name]
    try:
        took = session.call("ALVideoDevice", "setParameter", camera, number, value)
        return took is not False and (
            session.call("ALVideoDevice", "getParameter", camera, number) == value
        )
    except (CallRefusedError, ServiceMissingError):
        return False
