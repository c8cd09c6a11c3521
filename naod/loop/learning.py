"""Learning a colour from the next frames, and a goal from the next looks (5.1, equation 9)."""

from __future__ import annotations

import math
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from hal.types import Frame
from naod.approach.displacement import goal_from, shape_kind
from naod.errors import InputError
from naod.localisation.looks import combine
from naod.loop.equipment import Equipment
from naod.loop.outbox import Outbox
from naod.loop.state import Learning, LoopState
from naod.loop.types import Label
from naod.perception.colour_model import ColourModel, Region
from naod.perception.learning import learn_model

MIXED_LEVELS = 25.0
"""A surface of one colour in one light spreads less, shading included."""

FRAMES = 10
"""The paper's n."""


def begin_learning(
    equipment: Equipment, state: LoopState, ticket: int, region: Label, out: Outbox
) -> LoopState:
    """Start to gather frames of a region; the answer comes when there are enough."""
    if state.mode == "approach" or state.learning is not None or state.teaching is not None:
        out.refuse(ticket, "busy", "something else is under way; stop it first")
        return state
    camera = equipment.camera
    inside = region.x + region.width <= camera.width and region.y + region.height <= camera.height
    if min(region.x, region.y) < 0 or min(region.width, region.height) < 1 or not inside:
        text = f"region {region.x},{region.y},{region.width},{region.height} is not inside the "
        out.refuse(ticket, "bad_region", f"{text}{camera.width}x{camera.height} picture")
        return state
    return replace(
        state, mode="track", phase="learning", model=None, learning=Learning(ticket, region, state),
        target=None, looks=(), goal=None, error=None,
    )  # fmt: skip


def gather(state: LoopState, frame: Frame, out: Outbox) -> LoopState:
    """Add a frame; learn when there are enough. If that fails all is as it was before."""
    learning = state.learning
    if learning is None:
        return state
    frames = (*learning.frames, frame)
    if len(frames) < FRAMES:
        return replace(state, learning=replace(learning, frames=frames))
    region = learning.region
    try:
        box = Region(region.x, region.y, region.width, region.height)
        model = learn_model([f.yuyv for f in frames], box)
    except InputError as error:
        out.refuse(learning.ticket, "bad_region", str(error))
        before = learning.before
        return replace(
            state, learning=None, model=before.model, mode=before.mode, phase=before.phase
        )
    out.keep_model = model
    out.event("labelled", "learnt the object's colour")
    out.done(learning.ticket, _doubt(model))
    return replace(state, learning=None, model=model, phase="centre", search_from_ns=None)


def _doubt(model: ColourModel) -> str:
    """What a person should know of a colour that is hardly one."""
    spread = math.sqrt(float(np.linalg.eigvalsh(np.array(model.covariance))[-1]))
    if spread <= MIXED_LEVELS:
        return ""
    return (
        f"the region holds more than one colour (spread {spread:.0f} of 255 levels); "
        "mark less if the object is not found"
    )


def show_goal(equipment: Equipment, state: LoopState, out: Outbox) -> LoopState:
    """Remember the goal once enough looks were taken, or give up at the deadline."""
    teaching = state.teaching
    if teaching is None:
        return state
    if len(state.looks) >= equipment.config.approach.looks:
        look = combine(state.looks)
        goal = goal_from(shape_kind(equipment.shape), look.ego, look.sigma_m)
        out.keep_goal = (teaching.goal, goal)
        out.event("taught", f"goal {teaching.goal}: {goal.rho_m:.3f} m away")
        out.done(teaching.ticket)
        goals = MappingProxyType({**state.goals, teaching.goal: goal})
        return replace(state, goals=goals, teaching=None)
    if out.now_ns > teaching.deadline_ns:
        text = "the object was not seen centred and whole while standing still"
        out.refuse(teaching.ticket, "not_found", text)
        return replace(state, teaching=None)
    return state
