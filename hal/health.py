"""What a part of the robot says of its own condition when it is examined (`naod doctor`)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Protocol, runtime_checkable

Status = Literal["ok", "warn", "fail"]


@dataclass(frozen=True, slots=True)
class Finding:
    """One line of an examination.

    `check`: what was looked at, a few words such as "camera format"; the same from run to run.
    `text`: what was found, with its numbers. `advice`: what to do about it, "" when all is well.
    """

    check: str
    status: Status
    text: str
    advice: str = ""


@runtime_checkable
class Examined(Protocol):
    """A robot or a part of one that can say how it is. Optional: a backend need not have it.

    `Robot` objects may carry it. It is called with the robot open and standing; it neither moves
    the robot nor leaves anything changed, returns within 5 s, and turns what goes wrong into a
    finding rather than an exception. Worth telling, where the backend knows: versions of what it
    speaks to; controls of the camera that did not take; how far the camera's clock is from the
    body's; joints that are hot, soft or in error; calls the robot refused.
    """

    def examine(self) -> Sequence[Finding]:
        """What is worth telling, what is well included."""
        ...
