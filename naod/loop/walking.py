"""Sending steps to the walk and following them to their end."""

from __future__ import annotations

from dataclasses import replace

from hal.types import PlanarMotion
from naod.loop.outbox import Outbox
from naod.loop.state import LoopState, Move
from naod.messages import WalkCommand, WalkState

SOURCE = "tracker"
NOT_BEGUN_NS = 2_500_000_000
"""The walk's own reaction takes up to 0.8 s (`walk_facts.yaml`); after this it will not come."""
TOO_LONG_NS = 30_000_000_000


def _next_seq(state: LoopState, now_ns: int) -> int:
    # grows over restarts too, so that the walk server does not take a new life for a replay
    return max(state.walk_seq + 1, now_ns // 1_000_000)


def send_step(state: LoopState, step: PlanarMotion, out: Outbox) -> LoopState:
    """Command one bounded step; the looks from before it are worth nothing after it."""
    seq = _next_seq(state, out.now_ns)
    out.walk = WalkCommand(
        source=SOURCE, seq=seq, kind="step", x=step.x, y=step.y, yaw=step.yaw, ttl_ms=1000
    )
    move = Move(seq, out.now_ns, step)
    return replace(
        state, phase="walk", move=move, looks=(), walk_seq=seq, moves=state.moves + 1,
        still_since_ns=None, waiting_from_ns=None,
    )  # fmt: skip


def send_stop(state: LoopState, out: Outbox) -> LoopState:
    """Command to stand."""
    seq = _next_seq(state, out.now_ns)
    out.walk = WalkCommand(source=SOURCE, seq=seq, kind="stop", ttl_ms=1000)
    return replace(state, walk_seq=seq)


def follow(state: LoopState, walk: WalkState, now_ns: int) -> tuple[LoopState, str | None]:
    """The state after looking at the walk: None while under way, "done", or what went wrong."""
    move = state.move
    if move is None:
        return state, None
    if walk.moving and not move.begun:
        return replace(state, move=replace(move, begun=True)), None
    outcome = _outcome(move, walk, now_ns - move.sent_ns)
    if outcome is None:
        return state, None
    return replace(state, move=None, phase="settle"), outcome


def _outcome(move: Move, walk: WalkState, since_ns: int) -> str | None:
    if move.begun:
        if not walk.moving:
            return "done"
        return "the step took too long" if since_ns > TOO_LONG_NS else None
    ours = walk.last_source == SOURCE or (walk.refused or "").startswith(f"{SOURCE}:")
    if walk.refused and ours and since_ns > NOT_BEGUN_NS // 5:
        return walk.refused
    return "the walk did not begin" if since_ns > NOT_BEGUN_NS else None
