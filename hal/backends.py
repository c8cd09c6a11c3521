"""The backends by name. One is imported only when it is asked for."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import cast

from hal.errors import BackendError
from hal.protocols import Robot
from hal.simulation import Studio
from hal.types import CameraName, NaoVersion

BACKENDS: dict[str, str] = {
    "sim": "sim_backend.backend:open_robot",
}

STUDIOS: dict[str, str] = {
    "sim": "sim_backend.studio:open_studio",
}


@dataclass(frozen=True, slots=True)
class OpenOptions:
    """What every backend is told; `section` holds what only that backend understands.

    The "sim" backend takes in `section`: `scenario` (a Scenario or None; its robot's version wins
    over `version`), `scenario_folder` (a Path, where the scenario's pictures are), `seed` (int) and
    `real_time` (bool).
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


def _named(table: Mapping[str, str], backend: str) -> Callable[[OpenOptions], object]:
    if backend not in table:
        raise BackendError(
            f"there is no backend {backend!r}; there are: {', '.join(sorted(table))}"
        )
    module_name, _, function = table[backend].partition(":")
    try:
        module = importlib.import_module(module_name)
    except ImportError as error:
        raise BackendError(f"backend {backend!r} is not installed: {error}") from error
    return cast(Callable[[OpenOptions], object], getattr(module, function))
