"""The backends by name. One is imported only when it is asked for."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import cast

from hal.errors import BackendError
from hal.protocols import Robot
from hal.types import CameraName, NaoVersion

BACKENDS: dict[str, str] = {
    "sim": "sim_backend.backend:open_robot",
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
    if backend not in BACKENDS:
        raise BackendError(f"unknown backend {backend!r}; known: {', '.join(sorted(BACKENDS))}")
    module_name, _, function = BACKENDS[backend].partition(":")
    try:
        module = importlib.import_module(module_name)
    except ImportError as error:
        raise BackendError(f"backend {backend!r} is not installed: {error}") from error
    return cast(Robot, getattr(module, function)(options))
