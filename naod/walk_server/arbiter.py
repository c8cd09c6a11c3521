"""Who may walk, how far and how long: the pure core of the walk server.

`receive` takes one input into the state, `tick` lets time pass and says what the robot is to be
told. Nothing here reads a clock, a file or a socket. From the top: estop, the operator who holds
the walk, the tracker.
"""

from __future__ import annotations

from dataclasses import replace

from hal.types import PlanarMotion, WalkStatus
from naod.messages import TRACKER, WalkCommand
from naod.walk_server.report import report
from naod.walk_server.rules import Rules, fault_in, saturate
from naod.walk_server.sources import take
from naod.walk_server.types import (
    Action,
    ArbiterState,
    Estop,
    Halt,
    Heartbeat,
    Input,
    Motion,
    MoveTo,
    Received,
    Release,
    Renew,
    SetVelocity,
    Unreadable,
)

__all__ = [
    "Action",
    "ArbiterState",
    "Estop",
    "Halt",
    "Heartbeat",
    "Input",
    "Motion",
    "MoveTo",
    "Received",
    "Release",
    "Renew",
    "Rules",
    "SetVelocity",
    "Unreadable",
    "receive",
    "refuse",
    "refused_by_robot",
    "report",
    "tick",
]


def receive(state: ArbiterState, item: Input, status: WalkStatus, rules: Rules) -> ArbiterState:
    """The state after one input. Never raises, whatever the numbers in it."""
    if isinstance(item, Received):
        return _command(state, item.command, item.at_ns, status, rules)
    if isinstance(item, Unreadable):
        return refuse(state, item.reason, item.count)
    if isinstance(item, Heartbeat):
        return replace(state, tracker_ns=item.at_ns)
    if isinstance(item, Estop):
        return replace(_ended(state), estopped=True, held_by=None)
    if isinstance(item, Release):
        return replace(_ended(state), estopped=False, held_by=None)
    return replace(_ended(state), held_by=None)


def tick(
    state: ArbiterState, status: WalkStatus, now_ns: int, rules: Rules
) -> tuple[ArbiterState, Action | None]:
    """Let time pass; says what to tell the robot now."""
    state = _lapse(state, status, now_ns, rules)
    motion = state.motion
    if motion is None:
        restless = state.halt or status.velocity != PlanarMotion(0.0, 0.0, 0.0)
        return replace(state, halt=False), Halt() if restless else None
    valid_s = rules.valid_for_s
    if motion.kind == "velocity":
        valid_s = min(valid_s, (motion.ends_ns - now_ns) / 1e9 + rules.slack_s)
    if motion.sent:
        return state, Renew(valid_s)
    state = replace(state, halt=False, motion=replace(motion, sent=True))
    if motion.kind == "velocity":
        return state, SetVelocity(motion.target, valid_s)
    return state, MoveTo(motion.target, valid_s)


def refuse(state: ArbiterState, reason: str, count: int = 1) -> ArbiterState:
    """Count a refusal and say why."""
    return replace(state, refused=reason[:200], refusals=state.refusals + count)


def refused_by_robot(state: ArbiterState, reason: str) -> ArbiterState:
    """The robot did not take the motion: it has ended."""
    return refuse(replace(_ended(state), held_by=None), f"the robot refused: {reason}")


def _command(
    state: ArbiterState, command: WalkCommand, at_ns: int, status: WalkStatus, rules: Rules
) -> ArbiterState:
    known = take(state.last, command.source, command.seq, at_ns, rules)
    if isinstance(known, str):
        return refuse(state, f"{command.source}: {known}")
    # the number is used up even if the command is refused: replayed later it must not move
    state = replace(state, last=known)
    reason = _objection(state, command, status, at_ns)
    if reason is not None:
        return refuse(state, f"{command.source}: {reason}")
    operator = command.source != TRACKER
    until_ns = at_ns + command.ttl_ms * 1_000_000
    state = replace(
        state,
        last_source=command.source,
        refused=None,
        held_by=command.source if operator else None,
        held_until_ns=until_ns,
    )
    if command.kind == "stop":
        return _ended(state)
    target = saturate(command, rules)
    if command.kind == "step":
        until_ns = at_ns + int(rules.longest_step_s(target) * 1e9)
    motion = Motion(command.source, command.kind, target, at_ns, until_ns)
    return replace(state, motion=motion, halt=False)


def _objection(
    state: ArbiterState, command: WalkCommand, status: WalkStatus, at_ns: int
) -> str | None:
    """Why a command may not be obeyed now."""
    stop = command.kind == "stop"
    fault = None if stop else fault_in(command)
    if fault is not None:
        return fault
    if state.estopped and not stop:
        return "estop is latched"
    if status.fallen and not stop:
        return "the robot has fallen"
    holder = _holder(state, at_ns)
    if holder is None or command.source == holder:
        return None
    # any person may stop a robot that another one drives; the tracker may not interfere
    if stop and command.source != TRACKER:
        return None
    return f"{holder} holds the walk"


def _holder(state: ArbiterState, now_ns: int) -> str | None:
    held = state.held_by
    if held is None or now_ns < state.held_until_ns:
        return held
    motion = state.motion
    stepping = motion is not None and motion.kind == "step" and motion.source == held
    return held if stepping else None


def _ended(state: ArbiterState) -> ArbiterState:
    return replace(state, motion=None, halt=True)


def _lapse(state: ArbiterState, status: WalkStatus, now_ns: int, rules: Rules) -> ArbiterState:
    motion = state.motion
    if motion is not None:
        if motion.sent and status.moving and not motion.seen_moving:
            motion = replace(motion, seen_moving=True)
            state = replace(state, motion=motion)
        if state.estopped or status.fallen or _overdue(motion, state.tracker_ns, now_ns, rules):
            state = _ended(state)
        elif _arrived(motion, status, now_ns, rules):
            state = replace(state, motion=None)
    if state.held_by is not None and _holder(state, now_ns) is None:
        state = replace(state, held_by=None)
    return state


def _overdue(motion: Motion, tracker_ns: int | None, now_ns: int, rules: Rules) -> bool:
    if now_ns >= motion.ends_ns:
        return True
    if motion.kind != "step" or motion.source != TRACKER:
        return False
    alive_ns = max(motion.since_ns, tracker_ns or motion.since_ns)
    return now_ns - alive_ns > rules.tracker_silence_s * 1e9


def _arrived(motion: Motion, status: WalkStatus, now_ns: int, rules: Rules) -> bool:
    """A step has ended when the robot stands again, or never began to walk."""
    if motion.kind != "step" or not motion.sent or status.moving:
        return False
    return motion.seen_moving or now_ns - motion.since_ns > rules.step_start_s * 1e9
