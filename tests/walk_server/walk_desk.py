"""Playing inputs and ticks to the arbiter at chosen times."""

from __future__ import annotations

from dataclasses import replace

from hal.types import PlanarMotion, WalkStatus
from naod.messages import WalkCommand
from naod.walk_server import arbiter
from naod.walk_server.rules import Rules
from naod.walk_server.types import Action, ArbiterState, Input, Received

RULES = Rules()
MS = 1_000_000
ZERO = PlanarMotion(0.0, 0.0, 0.0)
STANDING = WalkStatus(0, False, False, ZERO, ZERO)
WALKING = WalkStatus(0, True, False, PlanarMotion(0.1, 0.0, 0.0), ZERO)
FALLEN = replace(STANDING, fallen=True)


class Desk:
    """Plays inputs and ticks at chosen times and keeps the last action."""

    def __init__(self) -> None:
        self.state = ArbiterState()
        self.seq = 0
        self.tick(0)

    def give(self, item: Input, status: WalkStatus = STANDING) -> None:
        self.state = arbiter.receive(self.state, item, status, RULES)

    def send(
        self,
        kind: str,
        source: str = "op",
        at_ms: float = 0.0,
        motion: tuple[float, float, float] = (0.05, 0.0, 0.0),
        status: WalkStatus = STANDING,
        ttl_ms: int = 300,
        seq: int | None = None,
    ) -> str | None:
        """Send a command; why it was refused, if it was."""
        self.seq += 1
        x, y, yaw = motion
        number = self.seq if seq is None else seq
        command = WalkCommand(
            source=source, seq=number, kind=kind, x=x, y=y, yaw=yaw, ttl_ms=ttl_ms
        )
        refusals = self.state.refusals
        self.give(Received(command, int(at_ms * MS)), status)
        return self.state.refused if self.state.refusals > refusals else None

    def tick(self, at_ms: float, status: WalkStatus = STANDING) -> Action | None:
        self.state, action = arbiter.tick(self.state, status, int(at_ms * MS), RULES)
        return action
