"""What the backend is told, checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from hal.backends import OpenOptions
from hal.errors import BackendError
from hal.naoqi.controls import GIVEN
from hal.naoqi.login import Login, find_login

_KNOWN: dict[str, type] = {
    "url": str,
    "user": str,
    "password_file": str,
    "wake_up": bool,
    "controls": dict,
}


@dataclass(frozen=True, slots=True)
class NaoqiOptions:
    """Where and as whom to connect; whether a walk may wake the robot up.

    `controls`: values of the camera's controls to hold, by the names of `controls.GIVEN`.
    """

    url: str
    login: Login | None
    wake_up: bool
    controls: Mapping[str, int]


def checked(options: OpenOptions) -> NaoqiOptions:
    """The backend's options. Raises BackendError."""
    section = options.section
    for key, value in section.items():
        if key not in _KNOWN:
            raise BackendError(f"unknown NAOqi option {key!r}; known: {', '.join(_KNOWN)}")
        if not isinstance(value, _KNOWN[key]):
            raise BackendError(f"{key}: not a {_KNOWN[key].__name__}: {value!r}")
    url = str(section.get("url", "tcp://127.0.0.1:9559"))
    if not url.startswith(("tcp://", "tcps://")):
        raise BackendError(f"url: {url!r} is neither tcp://HOST:PORT nor tcps://HOST:PORT")
    login = find_login(str(section.get("user", "nao")), str(section.get("password_file", "")))
    if url.startswith("tcps://") and login is None:
        raise BackendError("NAOqi over tcps needs a password; see password_file")
    return NaoqiOptions(
        url, login, bool(section.get("wake_up", True)), _controls(section.get("controls", {}))
    )


def _controls(told: object) -> dict[str, int]:
    assert isinstance(told, dict)
    for name, value in told.items():
        if name not in GIVEN or not isinstance(value, int):
            raise BackendError(f"controls: {name} = {value!r}; known: {', '.join(GIVEN)}")
    return dict(told)
