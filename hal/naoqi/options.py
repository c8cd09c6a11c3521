"""What the backend is told, checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import urlsplit

from hal.backends import OpenOptions
from hal.errors import BackendError
from hal.naoqi.controls import GIVEN
from hal.naoqi.login import Login, find_login

_KNOWN: dict[str, type] = {
    "url": str,
    "user": str,
    "password_file": str,
    "wake_up": bool,
    "velocity_by_leads": bool,
    "controls": dict,
}


@dataclass(frozen=True, slots=True)
class NaoqiOptions:
    """Where and as whom to connect; whether a walk may wake the robot up.

    `velocity_by_leads`: a velocity is walked as displacements that end by themselves (`lead`); so
    it is, unless told, where a network lies between, as the watchdog cannot reach over a cut one.
    `controls`: values of the camera's controls to hold, by the names of `controls.GIVEN`.
    """

    url: str
    login: Login | None
    wake_up: bool
    velocity_by_leads: bool
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
        url,
        login,
        wake_up=bool(section.get("wake_up", True)),
        velocity_by_leads=bool(section.get("velocity_by_leads", not _is_here(url))),
        controls=_controls(section.get("controls", {})),
    )


def _is_here(url: str) -> bool:
    """Whether NAOqi runs on this machine: the daemon is on the robot."""
    host = urlsplit(url).hostname or ""
    return host in ("localhost", "::1") or host.startswith("127.")


def _controls(told: object) -> dict[str, int]:
    assert isinstance(told, dict)
    for name, value in told.items():
        if name not in GIVEN or not isinstance(value, int):
            raise BackendError(f"controls: {name} = {value!r}; known: {', '.join(GIVEN)}")
    return dict(told)
