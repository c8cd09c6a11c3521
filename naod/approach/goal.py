"""A goal: where the robot stood relative to the object when it was shown (equation 9)."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec

from naod.errors import InputError
from naod.files import read_toml, write_toml

_NAME = re.compile(r"^[A-Za-z0-9_-]{1,32}$")


class Goal(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The object as seen from the goal's base frame, flattened to the floor.

    T_goal_object is given by the ego-cylinder: `rho_m`, `theta_rad`, `z_m`, and `phi_rad`, the
    azimuth of the object's z axis. `kind` is the object's shape, so that a goal shown with a can
    is not used with a board. `sigma_m` is how well it was seen.
    """

    kind: str
    rho_m: float
    theta_rad: float
    z_m: float
    phi_rad: float
    sigma_m: float = 0.0


def check_name(name: str) -> str:
    """The name, if it can be one. Raises InputError."""
    if not _NAME.match(name):
        raise InputError(f"goal name {name!r}: use 1 to 32 letters, digits, - or _")
    return name


def goal_path(folder: Path, name: str) -> Path:
    """Where a goal is kept."""
    return folder / "goals" / f"{check_name(name)}.toml"


def save_goal(folder: Path, name: str, goal: Goal) -> None:
    """Keep a goal, whole or not at all. Raises InputError."""
    write_toml(goal_path(folder, name), goal)


def load_goals(folder: Path) -> dict[str, Goal]:
    """All goals kept in a folder, by name. Raises InputError for a damaged file."""
    paths = sorted((folder / "goals").glob("*.toml"))
    return {path.stem: read_toml(path, Goal) for path in paths if _NAME.match(path.stem)}
