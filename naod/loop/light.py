"""Following slow light: which colour to look for now, and when not to trust it."""

from __future__ import annotations

from dataclasses import replace

from hal.types import Frame
from naod.loop.equipment import Sighting
from naod.loop.outbox import Outbox
from naod.loop.state import LoopState
from naod.perception.colour_model import ColourModel
from naod.perception.drift import SURE_ENOUGH, Drift, followed, seen_colour


def colour_now(state: LoopState) -> ColourModel | None:
    """The learnt colour as it looks in the light of the last sightings."""
    drift = state.drift
    return state.model if drift is None or drift.learnt is not state.model else drift.lit


def follow_light(
    state: LoopState, sighting: Sighting | None, frame: Frame | None, out: Outbox
) -> LoopState:
    """Learn from a sighting that is likely the object; say once when the colour is doubtful."""
    if state.model is None:
        return replace(state, drift=None) if state.drift is not None else state
    drift = state.drift
    if drift is None or drift.learnt is not state.model:
        drift = Drift.of(state.model)
    if sighting is None or frame is None or sighting.segmentation is None:
        return replace(state, drift=drift)
    if sighting.probability < SURE_ENOUGH or sighting.blob.clipped:
        return replace(state, drift=drift)
    colour = seen_colour(frame.yuyv, sighting.segmentation, sighting.blob)
    after = followed(drift, colour, sighting.stamp_ns)
    if after.doubtful and not drift.doubtful:
        out.event("colour_doubtful", "the object does not look as it did; learn its colour again")
    return replace(state, drift=after)
