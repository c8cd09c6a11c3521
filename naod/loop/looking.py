"""Gaze: keep the object centred, look for it when it is gone, take looks while standing."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from hal.types import HeadAngles
from naod.gaze.centring import head_towards, is_centred
from naod.gaze.search import DWELL_S, PLACES, search_place
from naod.localisation.placement import Placement
from naod.loop.elsewhere import is_there
from naod.loop.equipment import Equipment, Sighting
from naod.loop.expectation import Anchor, anchored, carried_on
from naod.loop.outbox import Outbox
from naod.loop.state import LoopState, Target
from naod.loop.types import Observation
from naod.messages import WalkState

SEARCH_S = 2.5 * DWELL_S * len(PLACES)
"""After so long the head rests; the object is still looked for where it points."""

ASIDE = frozenset({"left", "right"})

FRESH_NS = 500_000_000
"""A target seen within this time counts as in view."""


def stand(state: LoopState, walk: WalkState, now_ns: int) -> LoopState:
    """Since when the robot stands still; looks from before a movement are dropped."""
    if walk.fallen and state.target is not None:
        # whoever picks it up puts it down elsewhere, and odometry does not know
        state = replace(state, target=replace(state.target, anchor=None))
    if walk.moving or walk.fallen:
        return replace(state, still_since_ns=None, looks=())
    if state.still_since_ns is None:
        # what was lost on the way is looked for from here, from the first place on
        search_from = None if state.search_from_ns is None else now_ns
        return replace(state, still_since_ns=now_ns, search_from_ns=search_from)
    return state


def gaze(
    equipment: Equipment,
    state: LoopState,
    sighting: Sighting | None,
    seen: Observation,
    out: Outbox,
) -> LoopState:
    """Turn the head: towards what is seen, or on to the next place of the search."""
    if sighting is not None:
        return _centre(equipment, _noted(equipment, state, sighting, seen.walk, out), sighting, out)
    if state.target is not None and out.now_ns - state.target.seen_ns <= FRESH_NS:
        return state
    if seen.frame is None and state.search_from_ns is None:
        return state
    return _search(state, out)


def _noted(
    equipment: Equipment, state: LoopState, sighting: Sighting, walk: WalkState, out: Outbox
) -> LoopState:
    """Remember where it was seen; a picture without its pose leaves the place known before."""
    place = head_towards(
        sighting.ray_in_camera, sighting.T_torso_camera, sighting.head, equipment.camera_name, 1.0
    )
    if state.search_from_ns is not None and state.target is not None:
        out.event("found", "the object is in view again")
    before = state.target
    look, anchor = (before.look, before.anchor) if before else (None, None)
    if sighting.look is not None and sighting.placement is not None:
        look, anchor = sighting.look, _anchor(equipment, sighting, sighting.placement, walk)
    target = Target(sighting.stamp_ns, look, place, anchor, sighting.blur_px)
    return replace(state, target=target, search_from_ns=None)


def _anchor(
    equipment: Equipment, sighting: Sighting, placement: Placement, walk: WalkState
) -> Anchor:
    """Cut off, it may be metres from where it seems: what is known better is kept."""
    fresh, prior = anchored(placement, walk), sighting.expected
    if prior is None or not is_there(equipment, sighting, prior):
        return fresh
    if np.trace(fresh.covariance[:3, :3]) <= np.trace(prior.covariance[:3, :3]):
        return fresh
    return carried_on(prior, placement.T_base_camera, sighting.stamp_ns, walk)


def _centre(equipment: Equipment, state: LoopState, sighting: Sighting, out: Outbox) -> LoopState:
    wanted = state.target.place if state.target else sighting.head
    gain = equipment.config.gaze.gain
    now = sighting.head
    tolerance = math.radians(equipment.config.gaze.tolerance_deg)
    centred = is_centred(sighting.ray_in_camera, now, wanted, tolerance)
    if not is_centred(sighting.ray_in_camera, now, wanted, 0.3 * tolerance):
        out.head = HeadAngles(
            now.yaw_rad + gain * (wanted.yaw_rad - now.yaw_rad),
            now.pitch_rad + gain * (wanted.pitch_rad - now.pitch_rad),
        )
    return _take_look(equipment, state, sighting, centred)


def _take_look(
    equipment: Equipment, state: LoopState, sighting: Sighting, centred: bool
) -> LoopState:
    """Keep a look that was taken sharp, centred, and after the robot came to rest (S3).

    An object whose upper or lower end is out of the picture will do: both sides say how far it is.
    """
    settle_ns = int(equipment.config.approach.settle_s * 1e9)
    since = state.still_since_ns
    if since is None or sighting.stamp_ns < since + settle_ns:
        return state
    look, config = sighting.look, equipment.config.approach
    cut_aside = sighting.pose is None or not ASIDE.isdisjoint(sighting.pose.clipped)
    if look is None or not centred or cut_aside or look.blur_px > config.blur_max_px:
        return replace(state, phase="centre") if state.phase == "look" else state
    kept = (*state.looks, look)[-config.looks_max :]
    return replace(state, looks=kept)


def _search(state: LoopState, out: Outbox) -> LoopState:
    now = out.now_ns
    if state.search_from_ns is None:
        if state.target is not None:
            out.event("lost", "the object is out of view")
            state = replace(state, lost_count=state.lost_count + 1)
        state = replace(state, search_from_ns=now, looks=())
    searching_s = (now - (state.search_from_ns or now)) / 1e9
    first = state.target.place if state.target else None
    if state.still_since_ns is not None and searching_s < SEARCH_S:
        out.head = search_place(first, searching_s)
    return state
