"""Look-then-move: stand, centre, localise, one saturated move, again (paper 6)."""

from __future__ import annotations

import math
from dataclasses import replace

from hal.types import PlanarMotion
from naod.approach.certainty import Doubt, Tolerance, doubt_of, is_known, known_part
from naod.approach.displacement import displacement, saturate
from naod.config import ApproachConfig
from naod.gaze.search import DWELL_S, PLACES
from naod.localisation.looks import combine
from naod.loop.equipment import Equipment
from naod.loop.outbox import Outbox
from naod.loop.state import LoopState
from naod.loop.types import Observation
from naod.loop.walking import follow, send_step, send_stop

NO_PICTURE_NS = 1_000_000_000
"""S3: without a fresh picture for so long, stop."""

PATIENCE_NS = 15_000_000_000
"""Standing before something that gives no looks for so long, it is not the object."""


def approach(equipment: Equipment, state: LoopState, seen: Observation, out: Outbox) -> LoopState:
    """One tick of an approach that is under way."""
    if seen.walk.fallen:
        return fail(state, "the robot has fallen or was lifted", out)
    state, outcome = follow(state, seen.walk, out.now_ns)
    if outcome not in (None, "done"):
        return _not_walked(state, seen, outcome or "", out)
    if state.move is not None:
        return _while_walking(state, out)
    if seen.walk.held_by is not None:
        return replace(state, phase="held", looks=(), waiting_from_ns=None)
    return _while_standing(equipment, state, out)


def _while_standing(equipment: Equipment, state: LoopState, out: Outbox) -> LoopState:
    if state.search_from_ns is not None:
        return _while_lost(equipment, replace(state, waiting_from_ns=None), out)
    if len(state.looks) >= equipment.config.approach.looks:
        return _decide(equipment, state, out)
    since_ns = state.waiting_from_ns or out.now_ns
    if out.now_ns - since_ns > PATIENCE_NS:
        return fail(state, _why_no_looks(state, out.now_ns), out)
    settling = state.phase == "settle" and not state.looks
    return replace(state, phase="settle" if settling else "look", waiting_from_ns=since_ns)


def fail(state: LoopState, why: str, out: Outbox) -> LoopState:
    """Give up: stand, keep looking, say why."""
    state = send_stop(state, out)
    out.event("failed", f"approach to {state.goal} failed: {why}")
    return replace(state, mode="track", phase="failed", move=None)


def _decide(equipment: Equipment, state: LoopState, out: Outbox) -> LoopState:
    config = equipment.config.approach
    goal = state.goals[state.goal or ""]
    tolerance = Tolerance(config.tolerance_m, math.radians(config.tolerance_deg))
    look = combine(state.looks)
    error = displacement(look.ego, goal)
    step = saturate(error, config.step_max_m, math.radians(config.turn_max_deg))
    doubt = doubt_of(look, goal, tolerance)
    state = replace(state, error=error)
    known = is_known(step, doubt, tolerance)
    if not known and _may_look_on(state, config, out.now_ns):
        return replace(state, phase="look")
    if within(error, config):
        told = f"goal {state.goal} reached after {state.moves} moves"
        out.event("reached", told if known else f"{told}, as far as can be seen: {_said(doubt)}")
        return replace(state, mode="track", phase="reached")
    if state.moves >= config.moves_max:
        return fail(state, f"not there after {state.moves} moves", out)
    step = step if known else known_part(step, doubt)
    way = f"step {step.x:+.3f} m, {step.y:+.3f} m, {math.degrees(step.yaw):+.1f} deg"
    out.event("move", f"{way}, {_said(doubt)} after {len(state.looks)} looks")
    return send_step(state, step, out)


def _may_look_on(state: LoopState, config: ApproachConfig, now_ns: int) -> bool:
    """Whether more looks may be taken before what is known has to do."""
    looking_s = (now_ns - state.looks[0].stamp_ns) / 1e9
    return len(state.looks) < config.looks_max and looking_s < config.looking_max_s


def _said(doubt: Doubt) -> str:
    return f"within {1e3 * doubt.sigma_m:.1f} mm and {math.degrees(doubt.sigma_rad):.2f} deg"


def within(error: PlanarMotion, config: ApproachConfig) -> bool:
    """Whether the goal counts as reached."""
    close = math.hypot(error.x, error.y) <= config.tolerance_m
    return close and abs(error.yaw) <= math.radians(config.tolerance_deg)


def _while_walking(state: LoopState, out: Outbox) -> LoopState:
    if _is_blind(state, out.now_ns):
        return fail(state, "no picture from the camera for 1 s", out)
    return state


def _is_blind(state: LoopState, now_ns: int) -> bool:
    return state.frame_ns is None or now_ns - state.frame_ns > NO_PICTURE_NS


def _why_no_looks(state: LoopState, now_ns: int) -> str:
    if _is_blind(state, now_ns):
        return "no picture from the camera"
    return "something of the object's colour is in view, but not the object's outline"


def _while_lost(equipment: Equipment, state: LoopState, out: Outbox) -> LoopState:
    searching_s = (out.now_ns - (state.search_from_ns or out.now_ns)) / 1e9
    patience_s = equipment.config.approach.lost_s + DWELL_S * len(PLACES)
    if searching_s > patience_s:
        return fail(state, "the object was not found", out)
    return replace(state, phase="search")


def _not_walked(state: LoopState, seen: Observation, why: str, out: Outbox) -> LoopState:
    if seen.walk.held_by is not None:
        return replace(state, phase="held", looks=())
    return fail(state, why, out)
