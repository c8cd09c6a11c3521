"""Everything the loop remembers from one tick to the next; immutable."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal

from hal.types import Frame, HeadAngles, PlanarMotion
from naod.approach.goal import Goal
from naod.localisation.looks import Look
from naod.loop.expectation import Anchor
from naod.loop.types import Label
from naod.perception.colour_model import ColourModel
from naod.perception.drift import Drift

Mode = Literal["idle", "track", "approach"]
Phase = Literal[
    "idle",
    "learning",
    "centre",
    "look",
    "walk",
    "settle",
    "search",
    "held",
    "reached",
    "failed",
]


@dataclass(frozen=True, slots=True)
class Learning:
    """A colour being learnt: who asked, which region, the frames so far, what was known before."""

    ticket: int
    region: Label
    before: LoopState
    frames: tuple[Frame, ...] = ()


@dataclass(frozen=True, slots=True)
class Teaching:
    """A goal being shown: who asked, its name, until when the object may be found."""

    ticket: int
    goal: str
    deadline_ns: int


@dataclass(frozen=True, slots=True)
class Move:
    """A step of the walk under way: when it was sent, and what was seen of it since."""

    seq: int
    sent_ns: int
    step: PlanarMotion
    begun: bool = False


@dataclass(frozen=True, slots=True)
class Target:
    """Where the object was last seen; `place` is the head's target that centres it.

    `anchor` is where to expect it from; `blur_px` how blurred it was.
    """

    seen_ns: int
    look: Look | None
    place: HeadAngles
    anchor: Anchor | None = None
    blur_px: float = 0.0


@dataclass(frozen=True, slots=True)
class LoopState:
    """The loop's memory. `looks` are those taken from the present stance, object centred.

    `drift`: how the light stands to that in which `model` was learnt.
    `waiting_from_ns`: since when an approach has stood there waiting for looks.
    """

    mode: Mode = "idle"
    phase: Phase = "idle"
    model: ColourModel | None = None
    drift: Drift | None = None
    goals: Mapping[str, Goal] = field(default_factory=lambda: MappingProxyType({}))
    goal: str | None = None
    learning: Learning | None = None
    teaching: Teaching | None = None
    move: Move | None = None
    still_since_ns: int | None = None
    frame_ns: int | None = None
    target: Target | None = None
    search_from_ns: int | None = None
    waiting_from_ns: int | None = None
    looks: tuple[Look, ...] = ()
    error: PlanarMotion | None = None
    moves: int = 0
    lost_count: int = 0
    seq: int = 0
    walk_seq: int = 0

    @staticmethod
    def initial(goals: Mapping[str, Goal], model: ColourModel | None) -> LoopState:
        """Idle, with what earlier runs left in the state folder."""
        return LoopState(goals=MappingProxyType(dict(goals)), model=model)
