"""The loop's step: (state, observation, now) to (state, commands), without side effects.

The daemon, the lock-step simulation and the replay of a recording all run this function.
"""

from __future__ import annotations

import math
from dataclasses import replace

from naod.approach.displacement import shape_kind
from naod.localisation.camera_motion import CameraMotion
from naod.loop.approach import approach
from naod.loop.elsewhere import believed
from naod.loop.equipment import Equipment, Sighting
from naod.loop.expectation import expected
from naod.loop.learning import gather, show_goal
from naod.loop.light import colour_now, follow_light
from naod.loop.looking import gaze, stand
from naod.loop.outbox import Outbox
from naod.loop.report import state_message, with_error
from naod.loop.requests import handle
from naod.loop.state import LoopState
from naod.loop.types import Commands, Observation
from naod.pose.prior import Prior


def step(
    equipment: Equipment, state: LoopState, seen: Observation, now_ns: int
) -> tuple[LoopState, Commands]:
    """One tick. `now_ns` is the robot's clock."""
    sighting = look_at(equipment, state, seen)
    return decide(equipment, state, seen, sighting, now_ns)


def look_at(equipment: Equipment, state: LoopState, seen: Observation) -> Sighting | None:
    """The object in the picture of this tick, if there is a picture and a model to look with."""
    if seen.frame is None or state.model is None or state.mode == "idle":
        return None
    motion = equipment.motion(seen.around, seen.walk)
    prior = _expectation(equipment, state, seen, seen.frame.stamp_ns, motion)
    colour = colour_now(state) or state.model
    return equipment.sight(colour, seen.frame, seen.body, prior, motion)


def _expectation(
    equipment: Equipment,
    state: LoopState,
    seen: Observation,
    stamp_ns: int,
    motion: CameraMotion | None,
) -> Prior | None:
    anchor = state.target.anchor if state.target else None
    T_base_camera = equipment.T_base_camera(seen.body)
    if anchor is None or T_base_camera is None:
        return None
    turns_to_us = shape_kind(equipment.shape) == "cylinder"
    return expected(anchor, seen.walk, T_base_camera, stamp_ns, turns_to_us, motion)


def decide(
    equipment: Equipment,
    state: LoopState,
    seen: Observation,
    sighting: Sighting | None,
    now_ns: int,
) -> tuple[LoopState, Commands]:
    """What to do about it."""
    out = Outbox(now_ns)
    for request in seen.requests:
        state = handle(equipment, state, seen, request, out)
    state = stand(state, seen.walk, now_ns)
    if seen.frame is not None:
        state = gather(replace(state, frame_ns=seen.frame.stamp_ns), seen.frame, out)
    sighting = believed(equipment, state, sighting, now_ns)
    state = follow_light(state, sighting, seen.frame, out)
    if state.mode != "idle" and state.model is not None:
        state = gaze(equipment, state, sighting, seen, out)
        state = with_error(state)
        state = show_goal(equipment, state, out)
        if state.mode == "approach":
            state = approach(equipment, state, seen, out)
    state = replace(state, seq=state.seq + 1)
    speed = math.radians(equipment.config.gaze.speed_deg_s)
    return state, out.commands(state_message(state, seen, now_ns), speed)
