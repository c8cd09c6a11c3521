"""What the walk server tells the bus: its state at every tick, and what happened in between."""

from __future__ import annotations

from hal.types import WalkStatus
from naod.messages import WalkState
from naod.walk_server.types import ArbiterState


def report(state: ArbiterState, status: WalkStatus, seq: int) -> WalkState:
    """The `walk/state` message."""
    velocity, odometry = status.velocity, status.odometry
    return WalkState(
        seq=seq,
        stamp_ns=status.stamp_ns,
        moving=status.moving,
        fallen=status.fallen,
        held_by=state.held_by,
        velocity=(velocity.x, velocity.y, velocity.yaw),
        last_source=state.last_source,
        refused=state.refused,
        odometry=(odometry.x, odometry.y, odometry.yaw),
    )


def happened(
    before: ArbiterState, after: ArbiterState, last: WalkState | None, now: WalkState
) -> list[tuple[str, str]]:
    """Kind and text of the events between two ticks."""
    events = []
    if after.estopped != before.estopped:
        latched = ("estop", "stopped, latched until release")
        events.append(latched if after.estopped else ("release", "the estop is over"))
    was_fallen = last is not None and last.fallen
    if now.fallen != was_fallen:
        up = ("upright", "the robot stands again")
        events.append(("fallen", "the robot has fallen or is lifted") if now.fallen else up)
    if after.held_by != before.held_by:
        taken = ("walk_held", f"{after.held_by} holds the walk")
        events.append(taken if after.held_by else ("walk_free", "nobody holds the walk"))
    return events
