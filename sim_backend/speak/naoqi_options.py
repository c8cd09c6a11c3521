"""What the NAOqi peer is told beyond the simulation: faults, login, what it does not offer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Literal, get_args

from hal.backends import OpenOptions
from hal.errors import BackendError

KEY = "naoqi"
"""Where in `OpenOptions.section` the peer's own options are; the rest is the simulation's."""

ImageForm = Literal["raw", "list", "tuple"]
"""Pixels declared raw in a tuple, or undeclared in a list or a tuple: then they come as a text."""


@dataclass(frozen=True, slots=True)
class PeerOptions:
    """`clock_offset_s`: the robot's clock minus this machine's; `picture_offset_s`: the pictures'
    clock minus the robot's. `missing`: services it does not offer. `resting`: motors off at first.
    `password`: as NAOqi 2.9 asks for one, from user `user`; `certificate` and `key`: PEM files,
    then it speaks tcps. `move_begins_s`: before a move begins. `life`: state at first.
    """

    resting: bool = False
    life: str = "solitary"
    image: ImageForm = "raw"
    missing: tuple[str, ...] = ()
    clock_offset_s: float = 4321.5
    picture_offset_s: float = 0.0
    move_begins_s: float = 0.1
    user: str = "nao"
    password: str = ""
    certificate: str = ""
    key: str = ""


def split(options: OpenOptions) -> tuple[PeerOptions, OpenOptions]:
    """The peer's own options, and the simulation's. Raises BackendError."""
    told = options.section.get(KEY, {})
    if not isinstance(told, Mapping):
        raise BackendError(f"{KEY}: not a table")
    known = {field.name for field in fields(PeerOptions)}
    for name in told:
        if name not in known:
            raise BackendError(f"unknown option of the NAOqi peer {name!r}; known: {sorted(known)}")
    if told.get("image", "raw") not in get_args(ImageForm):
        raise BackendError(f"image: {told['image']!r} is none of {get_args(ImageForm)}")
    rest = {name: value for name, value in options.section.items() if name != KEY}
    peer = PeerOptions(**{**told, "missing": tuple(told.get("missing", ()))})
    return peer, replace(options, section={**rest, "real_time": True})
