"""What goes into the arbiter, what it remembers, and what comes out of it. All of it is data."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from hal.types import PlanarMotion
from naod.messages import WalkCommand
from naod.walk_server.sources import NOBODY, Sources


@dataclass(frozen=True, slots=True)
class Received:
    """A well-formed command and when it came."""

    command: WalkCommand
    at_ns: int


@dataclass(frozen=True, slots=True)
class Unreadable:
    """Something came that is no command, or several such; `reason` says why."""

    reason: str
    count: int = 1


@dataclass(frozen=True, slots=True)
class Heartbeat:
    """The tracker published its state."""

    at_ns: int


@dataclass(frozen=True, slots=True)
class Estop:
    """Stop and stay so."""


@dataclass(frozen=True, slots=True)
class Release:
    """The estop is over; nothing moves by that."""


@dataclass(frozen=True, slots=True)
class End:
    """End the present motion and let go of the walk."""


Input = Received | Unreadable | Heartbeat | Estop | Release | End


@dataclass(frozen=True, slots=True)
class SetVelocity:
    """Tell the robot a velocity."""

    velocity: PlanarMotion
    valid_for_s: float


@dataclass(frozen=True, slots=True)
class MoveTo:
    """Tell the robot a step."""

    step: PlanarMotion
    valid_for_s: float


@dataclass(frozen=True, slots=True)
class Renew:
    """Let the present motion go on."""

    valid_for_s: float


@dataclass(frozen=True, slots=True)
class Halt:
    """Stop."""


Action = SetVelocity | MoveTo | Renew | Halt


@dataclass(frozen=True, slots=True)
class Motion:
    """The motion that is under way; `ends_ns` is its ttl, for a step the longest it may take."""

    source: str
    kind: Literal["velocity", "step"]
    target: PlanarMotion
    since_ns: int
    ends_ns: int
    sent: bool = False
    seen_moving: bool = False


@dataclass(frozen=True, slots=True)
class ArbiterState:
    """Everything the walk server remembers.

    A fresh state halts the robot first of all (S8).
    """

    estopped: bool = False
    motion: Motion | None = None
    halt: bool = True
    held_by: str | None = None
    held_until_ns: int = 0
    last: Sources = field(default_factory=lambda: NOBODY)
    last_source: str | None = None
    refused: str | None = None
    refusals: int = 0
    tracker_ns: int | None = None
