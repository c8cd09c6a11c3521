"""The backends by name. One is imported only when it is asked for."""

from __future__ import annotations

import importlib
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import cast

from hal.errors import BackendError
from hal.health import Finding
from hal.protocols import Robot
from hal.simulation import Studio
from hal.timing import LoopTiming
from hal.types import CameraName, NaoVersion

BACKENDS: dict[str, str] = {
    "sim": "sim_backend.backend:open_robot",
    "lola": "hal.lola.robot:open_robot",
    "naoqi": "hal.naoqi.robot:open_robot",
}

STUDIOS: dict[str, str] = {
    "sim": "sim_backend.studio:open_studio",
}

PEERS: dict[str, str] = {
    "lola": "sim_backend.speak.lola:serve",
    "naoqi": "sim_backend.speak.naoqi:serve",
}
"""Simulated robots that speak a real one's protocol, for any program to connect to."""

TIMINGS: dict[str, str] = {
    "lola": "sim_backend.speak.lola_timing:measure",
}

EXAMINERS: dict[str, str] = {
    "sim": "sim_backend.visit:examine",
    "lola": "hal.lola.visit:examine",
    "naoqi": "hal.naoqi.visit:examine",
}

Ready = Callable[[dict[str, object]], None]
"""Told once, when a peer can be connected to, what it serves and where."""


@dataclass(frozen=True, slots=True)
class OpenOptions:
    """What every backend is told; `section` holds what only that backend understands.

    The "sim" backend takes in `section`: `scenario` (a Scenario or None; its robot's version wins
    over `version`), `scenario_folder` (a Path, where the scenario's pictures are), `seed` (int) and
    `real_time` (bool).

    The "lola" backend takes `socket` (path of LoLA's) and `device` (str, as
    `hal.video.source.open_camera` takes it; "" for the robot's own camera by V4L2). It and "naoqi"
    take `controls` too: values of the camera's controls to hold (dict of str to int, by the names
    of `hal.video.v4l2_controls.ControlName`).

    The "lola" backend takes `socket`, and when the robot moves by itself: `stand_up` ("button": by
    the chest button only, "start": once it is connected) and `sit_after_s` without a client; and
    `when_fallen` ("limp": let go, "stiff": hold).

    The "naoqi" backend takes `url`, `user`, `password_file` ("": the environment's NAOQI_PASSWORD,
    or no login), `wake_up` (bool: whether a walk may wake up a robot that rests) and
    `velocity_by_leads` (bool, see `hal.naoqi.options`).
    """

    name: str = "nao"
    version: NaoVersion = "v6"
    camera: CameraName = "top"
    width: int = 640
    height: int = 480
    fps: int = 15
    section: Mapping[str, object] = field(default_factory=dict)


def open_robot(backend: str, options: OpenOptions) -> Robot:
    """Open a robot by the name of its backend. Raises BackendError."""
    return cast(Robot, _named(BACKENDS, backend)(options))


def open_studio(backend: str, options: OpenOptions) -> Studio:
    """Open a backend's studio, which takes pictures without a robot.

    It is told what a robot's backend is told. Raises BackendError or ScenarioError.
    """
    return cast(Studio, _named(STUDIOS, backend)(options))


def examine(backend: str, options: OpenOptions) -> list[Finding]:
    """Look at a robot without taking it over: it is not moved, and nothing is left changed.

    For when nobody has it open; a robot that is open can be `hal.health.Examined` by itself. What
    is wrong with the robot is a finding. Raises BackendError for a wrong name or options.
    """
    return cast(list[Finding], _named(EXAMINERS, backend)(options))


def speak(
    protocol: str,
    options: OpenOptions,
    address: str,
    camera: str | None,
    stop: threading.Event,
    ready: Ready,
) -> None:
    """Be a simulated robot that speaks a protocol of `PEERS`, until `stop` is set.

    `options` is what the "sim" backend is told, `real_time` included. `address`: where to listen,
    as the protocol writes it ("lola": the path of a socket; "naoqi": a url). `camera`: where to
    serve the camera's pictures beside it; None for nowhere. Returns with everything closed. Raises
    BackendError or ScenarioError, each with one line.
    """
    _named(PEERS, protocol)(options, address, camera, stop, ready)


def time_loop(backend: str, seconds: float, *, in_process: bool, real_time: bool) -> LoopTiming:
    """Measure how soon a backend's own loop answers its robot, for so long.

    `in_process`: in a thread of this process, else as the backend does it. Raises BackendError.
    """
    measure = _named(TIMINGS, backend)
    return cast(LoopTiming, measure(seconds, in_process, real_time))


def _named(table: Mapping[str, str], backend: str) -> Callable[..., object]:
    if backend not in table:
        raise BackendError(
            f"there is no backend {backend!r}; there are: {', '.join(sorted(table))}"
        )
    module_name, _, function = table[backend].partition(":")
    try:
        module = importlib.import_module(module_name)
    except ImportError as error:
        raise BackendError(f"backend {backend!r} is not installed: {error}") from error
    return cast(Callable[..., object], getattr(module, function))
