"""What one tick has decided so far; gathered here, then frozen into Commands."""

from __future__ import annotations

from dataclasses import dataclass, field

from hal.types import HeadAngles
from naod.approach.goal import Goal
from naod.loop.types import Commands, Reply
from naod.messages import EventMessage, StateMessage, WalkCommand
from naod.perception.colour_model import ColourModel


@dataclass(slots=True)
class Outbox:
    """Gathers the commands of one tick."""

    now_ns: int
    head: HeadAngles | None = None
    walk: WalkCommand | None = None
    events: list[EventMessage] = field(default_factory=list)
    replies: list[Reply] = field(default_factory=list)
    keep_goal: tuple[str, Goal] | None = None
    keep_model: ColourModel | None = None

    def event(self, kind: str, message: str) -> None:
        """Something happened, once."""
        self.events.append(EventMessage(stamp_ns=self.now_ns, kind=kind, message=message))

    def done(self, ticket: int, message: str = "") -> None:
        """A request was carried out."""
        self.replies.append(Reply(ticket, None, message))

    def refuse(self, ticket: int, code: str, message: str) -> None:
        """A request was refused, with the reason."""
        self.replies.append(Reply(ticket, code, message))

    def commands(self, state: StateMessage, head_speed_rad_s: float) -> Commands:
        """Everything decided in this tick."""
        return Commands(
            state=state,
            head=self.head,
            head_speed_rad_s=head_speed_rad_s,
            walk=self.walk,
            events=tuple(self.events),
            replies=tuple(self.replies),
            keep_goal=self.keep_goal,
            keep_model=self.keep_model,
        )
