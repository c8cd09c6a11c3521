"""What goes into the loop's step and what comes out of it. All of it is data."""

from __future__ import annotations

from dataclasses import dataclass

from hal.types import BodyState, Frame, HeadAngles
from naod.approach.goal import Goal
from naod.messages import EventMessage, StateMessage, WalkCommand, WalkState
from naod.perception.colour_model import ColourModel


@dataclass(frozen=True, slots=True)
class Start:
    """Walk to a goal that was shown."""

    goal: str


@dataclass(frozen=True, slots=True)
class Stop:
    """Stop walking, keep looking."""


@dataclass(frozen=True, slots=True)
class Label:
    """Learn the object's colour from a region of the coming frames, in pixels."""

    x: int
    y: int
    width: int
    height: int


@dataclass(frozen=True, slots=True)
class Teach:
    """Remember the present pose relative to the object under a name."""

    goal: str


Verb = Start | Stop | Label | Teach


@dataclass(frozen=True, slots=True)
class Request:
    """Somebody asks for something; the answer carries the same `ticket`."""

    ticket: int
    verb: Verb


@dataclass(frozen=True, slots=True)
class Reply:
    """The answer: `error_code` is None when it was done."""

    ticket: int
    error_code: str | None = None
    message: str = ""


@dataclass(frozen=True, slots=True)
class Observation:
    """What the robot senses at one tick.

    `frame` is None when no picture came since the last tick; `body` is the state at the time of
    the frame if there is one, else the newest. `around`: the body shortly before and after it.
    """

    frame: Frame | None
    body: BodyState
    walk: WalkState
    requests: tuple[Request, ...] = ()
    around: tuple[BodyState, BodyState] | None = None


@dataclass(frozen=True, slots=True)
class Commands:
    """What is to happen after a tick; the shell carries it out.

    `keep_goal` and `keep_model` are to be written to the state folder.
    """

    state: StateMessage
    head: HeadAngles | None = None
    head_speed_rad_s: float = 0.0
    walk: WalkCommand | None = None
    events: tuple[EventMessage, ...] = ()
    replies: tuple[Reply, ...] = ()
    keep_goal: tuple[str, Goal] | None = None
    keep_model: ColourModel | None = None
