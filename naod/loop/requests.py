"""The verbs: what is asked for, and whether it can be done now."""

from __future__ import annotations

from dataclasses import replace

from naod.approach.displacement import shape_kind
from naod.loop.equipment import Equipment
from naod.loop.learning import begin_learning
from naod.loop.outbox import Outbox
from naod.loop.state import LoopState, Teaching
from naod.loop.types import Label, Observation, Request, Start, Stop, Teach
from naod.loop.walking import send_stop

TEACH_PATIENCE_NS = 20_000_000_000


def handle(
    equipment: Equipment, state: LoopState, seen: Observation, request: Request, out: Outbox
) -> LoopState:
    """The state after a request; the answer goes into the outbox, now or later."""
    verb = request.verb
    if isinstance(verb, Stop):
        return _stop(state, request.ticket, out)
    if isinstance(verb, Label):
        return begin_learning(equipment, state, request.ticket, verb, out)
    if state.model is None:
        out.refuse(request.ticket, "no_model", "no colour has been learnt: label the object first")
        return state
    if isinstance(verb, Start):
        return _start(equipment, state, seen, request.ticket, verb, out)
    return _teach(state, seen, request.ticket, verb, out)


def _stop(state: LoopState, ticket: int, out: Outbox) -> LoopState:
    if state.mode == "approach" or state.move is not None:
        state = send_stop(state, out)
        out.event("stopped", f"approach to {state.goal} stopped on request")
    out.done(ticket)
    state = replace(state, goal=None, error=None, move=None, looks=())
    return state if state.mode == "idle" else replace(state, mode="track", phase="centre")


def _start(
    equipment: Equipment,
    state: LoopState,
    seen: Observation,
    ticket: int,
    verb: Start,
    out: Outbox,
) -> LoopState:
    goal = state.goals.get(verb.goal)
    kind = shape_kind(equipment.shape)
    if goal is None:
        known = ", ".join(sorted(state.goals)) or "none"
        out.refuse(ticket, "unknown_goal", f"goal {verb.goal!r} was never taught; known: {known}")
        return state
    if goal.kind != kind:
        text = f"goal {verb.goal!r} was taught with a {goal.kind}, the object is a {kind}"
        out.refuse(ticket, "wrong_object", text)
        return state
    if seen.walk.fallen:
        out.refuse(ticket, "fallen", "the robot has fallen or is lifted")
        return state
    if state.learning is not None or state.teaching is not None:
        out.refuse(ticket, "busy", "still learning; try again when that is done")
        return state
    out.done(ticket)
    out.event("started", f"approach to {verb.goal}")
    return replace(
        state, mode="approach", phase="centre", goal=verb.goal, move=None, looks=(), error=None,
        moves=0, search_from_ns=None, waiting_from_ns=None,
    )  # fmt: skip


def _teach(state: LoopState, seen: Observation, ticket: int, verb: Teach, out: Outbox) -> LoopState:
    if state.mode == "approach":
        out.refuse(ticket, "busy", "an approach is under way; stop it first")
        return state
    if state.teaching is not None or state.learning is not None:
        out.refuse(ticket, "busy", "still learning; try again when that is done")
        return state
    if seen.walk.fallen:
        out.refuse(ticket, "fallen", "the robot has fallen or is lifted")
        return state
    teaching = Teaching(ticket, verb.goal, out.now_ns + TEACH_PATIENCE_NS)
    return replace(
        state, mode="track", phase="centre", goal=None, error=None, looks=(), teaching=teaching,
        search_from_ns=None,
    )  # fmt: skip
