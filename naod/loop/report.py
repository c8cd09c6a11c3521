"""The `state` message, made from the loop's memory."""

from __future__ import annotations

from dataclasses import replace

from naod.approach.displacement import displacement
from naod.loop.looking import FRESH_NS
from naod.loop.state import LoopState, Target
from naod.loop.types import Observation
from naod.messages import EgoMessage, ErrorMessage, StateMessage, TargetMessage

STALE_PICTURE_NS = 1_000_000_000


def with_error(state: LoopState) -> LoopState:
    """The error to the goal from the newest look, for whoever watches."""
    goal = state.goals.get(state.goal) if state.goal else None
    look = state.target.look if state.target else None
    if goal is None or look is None:
        return state
    return replace(state, error=displacement(look.ego, goal))


def state_message(state: LoopState, seen: Observation, now_ns: int) -> StateMessage:
    """What is published at each tick."""
    error = state.error
    return StateMessage(
        seq=state.seq,
        stamp_ns=now_ns,
        mode=state.mode,
        phase=state.phase,
        goal=state.goal,
        target=_target(state.target, now_ns),
        error=ErrorMessage(x_m=error.x, y_m=error.y, yaw_rad=error.yaw) if error else None,
        faults=_faults(state, seen, now_ns),
    )


def _target(target: Target | None, now_ns: int) -> TargetMessage:
    if target is None:
        return TargetMessage(found=False, age_s=None, ego=None, sigma_m=None)
    age_ns = now_ns - target.seen_ns
    look = target.look
    ego = None
    if look is not None:
        ego = EgoMessage(
            rho_m=look.ego.rho_m,
            theta_rad=look.ego.theta_rad,
            z_m=look.ego.z_m,
            phi_rad=look.ego.phi_rad,
        )
    sigma = look.sigma_m if look else None
    return TargetMessage(found=age_ns <= FRESH_NS, age_s=age_ns / 1e9, ego=ego, sigma_m=sigma)


def _faults(state: LoopState, seen: Observation, now_ns: int) -> tuple[str, ...]:
    faults = []
    if state.frame_ns is None or now_ns - state.frame_ns > STALE_PICTURE_NS:
        faults.append("no_picture")
    if seen.walk.fallen:
        faults.append("fallen")
    if state.drift is not None and state.drift.doubtful:
        faults.append("colour_doubtful")
    return tuple(faults)
