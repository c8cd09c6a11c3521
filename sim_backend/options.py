"""What the backend is told, checked."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from hal.backends import OpenOptions
from hal.errors import BackendError
from hal.nao.cameras import SIZES
from hal.scenario import Scenario
from hal.types import NaoVersion
from sim_backend.defaults import resolved

_KNOWN = ("scenario", "scenario_folder", "seed", "real_time")


@dataclass(frozen=True, slots=True)
class SimOptions:
    """`scenario` is resolved; `folder` is where its pictures are looked for."""

    scenario: Scenario
    folder: Path
    seed: int
    real_time: bool
    version: NaoVersion


def checked(options: OpenOptions) -> SimOptions:
    """The simulation's options. Raises BackendError or ScenarioError, each one line."""
    section = options.section
    for key in section:
        if key not in _KNOWN:
            raise BackendError(f"unknown simulation option {key!r}; known: {', '.join(_KNOWN)}")
    scenario, folder = section.get("scenario"), section.get("scenario_folder")
    seed, real_time = section.get("seed", 0), section.get("real_time", False)
    if scenario is not None and not isinstance(scenario, Scenario):
        raise BackendError(f"scenario: not a Scenario but {type(scenario).__name__}")
    if folder is not None and not isinstance(folder, Path):
        raise BackendError(f"scenario_folder: not a path but {type(folder).__name__}")
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        raise BackendError(f"seed: not a whole number from 0 on: {seed!r}")
    if not isinstance(real_time, bool):
        raise BackendError(f"real_time: neither True nor False: {real_time!r}")
    if (options.width, options.height) not in SIZES:
        known = ", ".join(f"{width}x{height}" for width, height in SIZES)
        raise BackendError(f"no camera size {options.width}x{options.height}; known: {known}")
    if not 1 <= options.fps <= 30:
        raise BackendError(f"fps: {options.fps} is not from 1 to 30")
    version = options.version if scenario is None else scenario.robot.version
    filled = resolved(Scenario() if scenario is None else scenario)
    return SimOptions(filled, folder or Path.cwd(), seed, real_time, version)
