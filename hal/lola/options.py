"""What the backend is told, checked."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping

from hal.backends import OpenOptions
from hal.errors import BackendError
from hal.lola.told import Told
from hal.video.v4l2_controls import ControlName

_KNOWN = ("socket", "device", "controls", "sit_after_s", "stand_up", "when_fallen")
_PATH_MAX_BYTES = 107


Controls = Mapping[ControlName, int]


def checked(options: OpenOptions) -> tuple[Told, str, Controls]:
    """What the process is told, the camera's device and its controls (see `hal.video.source`).

    Raises BackendError, with one line.
    """
    section = options.section
    for key in section:
        if key not in _KNOWN:
            raise BackendError(f"unknown LoLA option {key!r}; known: {', '.join(_KNOWN)}")
    if options.version != "v6":
        raise BackendError(f"LoLA is of the V6, not of the {options.version}")
    path = section.get("socket", "/tmp/robocup")
    if not isinstance(path, str) or not 0 < len(os.fsencode(path)) <= _PATH_MAX_BYTES:
        raise BackendError(f"socket: not a path of 1 to {_PATH_MAX_BYTES} bytes: {path!r}")
    device = section.get("device", "")
    if not isinstance(device, str):
        raise BackendError(f"device: not a text: {device!r}")
    controls = section.get("controls", {})
    if not isinstance(controls, Mapping):
        raise BackendError(f"controls: not a table: {controls!r}")
    sit_after_s = section.get("sit_after_s", 10.0)
    if isinstance(sit_after_s, bool) or not isinstance(sit_after_s, int | float):
        raise BackendError(f"sit_after_s: not a number: {sit_after_s!r}")
    if not (math.isfinite(sit_after_s) and sit_after_s > 0.0):
        raise BackendError(f"sit_after_s: not positive: {sit_after_s!r}")
    stand_up = section.get("stand_up", "button")
    if stand_up not in ("button", "start"):
        raise BackendError(f"stand_up: neither 'button' nor 'start': {stand_up!r}")
    when_fallen = section.get("when_fallen", "limp")
    if when_fallen not in ("limp", "stiff"):
        raise BackendError(f"when_fallen: neither 'limp' nor 'stiff': {when_fallen!r}")
    told = Told(
        socket=path,
        sit_after_s=float(sit_after_s),
        stand_up="start" if stand_up == "start" else "button",
        when_fallen="stiff" if when_fallen == "stiff" else "limp",
    )
    return told, device, controls
