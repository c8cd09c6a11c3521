"""Telling the robot what the arbiter decided."""

from __future__ import annotations

from hal.protocols import Walk
from naod.walk_server.types import Action, Halt, MoveTo, SetVelocity


def carry_out(walk: Walk, action: Action) -> None:
    """Tell the robot. Raises HalError."""
    if isinstance(action, SetVelocity):
        walk.set_velocity(action.velocity, action.valid_for_s)
    elif isinstance(action, MoveTo):
        walk.move_to(action.step, action.valid_for_s)
    elif isinstance(action, Halt):
        walk.stop()
    else:
        walk.renew(action.valid_for_s)
