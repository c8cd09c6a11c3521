"""The walk's phases: standing, shifting the weight, stepping, coming to rest.

A footstep is fixed one step ahead (NAOqi's preview of about two steps): a new command changes the
step after the next. `halt` cuts the preview: the foot in the air lands, the other closes up.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from sim_backend.motions import Glide, Sway, pose_rates
from sim_backend.poses import ORIGIN, Pose, compose, midway
from sim_backend.steps import (
    STEP_PERIOD_S,
    Intent,
    first_side,
    is_done,
    landing,
    next_step,
)

START_S = 0.8
"""From a command to the first foot in motion: 0.2 s of planning, 0.6 s of double support."""
SHIFT_S = 0.6
END_S = 0.6
HALT_S = 0.3
"""A stop asked for waits for less: standing within 1.2 s, whatever the walk is doing."""

PhaseName = Literal["stand", "start", "step", "end"]


@dataclass(frozen=True, slots=True)
class Step:
    """One foot's way: `side` 1 left or -1 right, the base it leads to, where it lands."""

    side: int
    base: Pose
    lands: Pose


class Gait:
    """Where the soles and the body's reference are meant to be, in the odometry frame.

    Holds no clock: `run` moves it on by a time in seconds.
    """

    def __init__(self) -> None:
        self._intent: Intent = None
        self._halted = False
        self.phase: PhaseName = "stand"
        self.elapsed_s = 0.0
        self.duration_s = 0.0
        self.base: Pose = ORIGIN
        self.feet: dict[int, Pose] = {1: landing(ORIGIN, 1), -1: landing(ORIGIN, -1)}
        self.step: Step | None = None
        self._following: Step | None = None
        self.glide = Glide.resting(ORIGIN)
        self.sway = Sway.resting()

    @property
    def standing(self) -> bool:
        """Both feet stand and nothing is about to move."""
        return self.phase == "stand"

    @property
    def intent(self) -> Intent:
        """What it walks towards; None when it has been told to stop or has arrived."""
        return None if is_done(self._intent, self.base) else self._intent

    def reference(self) -> Pose:
        """The middle between the feet as the body follows it."""
        return self.glide.pose(self.elapsed_s)

    def stood_up(self) -> Gait:
        """Another gait, standing with parallel feet where this one is now."""
        other = Gait()
        other.base = self.reference()
        other.feet = {side: landing(other.base, side) for side in (1, -1)}
        other.glide = Glide.resting(other.base)
        return other

    def command(self, intent: Intent) -> None:
        """Walk like this from the first step that can still be changed."""
        self._intent = intent
        self._halted = False

    def halt(self) -> None:
        """End on both feet as soon as is safe."""
        self._intent = None
        self._halted = True
        if self.phase == "start":
            self._come_to_rest(HALT_S)
        elif self.step is not None:
            self._following = self._plan_after(self.step)

    def run(self, dt: float) -> None:
        """Move on by `dt` seconds."""
        if self.phase == "stand":
            if is_done(self._intent, self.base):
                return
            self._start()
        self.elapsed_s += dt
        while self.phase != "stand" and self.elapsed_s >= self.duration_s - 1e-9:
            self._next_phase(self.elapsed_s - self.duration_s)

    def _enter(self, phase: PhaseName, duration: float) -> None:
        self.phase, self.duration_s, self.elapsed_s = phase, duration, 0.0

    def _start(self) -> None:
        self._enter("start", START_S)
        self.glide = Glide.resting(self.reference())
        self.sway = Sway.shift(-first_side(self._intent, self.base), START_S - SHIFT_S, SHIFT_S)

    def _next_phase(self, late: float) -> None:
        if self.phase == "end":
            self._enter("stand", 0.0)
            self.glide = Glide.resting(midway(self.feet[1], self.feet[-1]))
            self.sway = Sway.resting()
            return
        following = self._first() if self.phase == "start" else self._land()
        if following is None:
            self._come_to_rest(HALT_S if self._halted else END_S)
        else:
            self._take(following)
        self.elapsed_s = late

    def _first(self) -> Step | None:
        if is_done(self._intent, self.base):
            return None
        side = 1 if self.sway.ends_towards < 0 else -1
        return self._towards(side, self.base)

    def _land(self) -> Step | None:
        assert self.step is not None
        self.feet[self.step.side] = self.step.lands
        self.base = self.step.base
        return self._following

    def _take(self, step: Step) -> None:
        """Begin a step, having fixed the one after it."""
        start = self.glide.pose(self.duration_s)
        rates = self.glide.end_rates
        self.step = step
        self._following = self._plan_after(step)
        end = midway(self.feet[-step.side], step.lands)
        after = midway(step.lands, self._following.lands) if self._following else None
        end_rates = ORIGIN if after is None else pose_rates(start, after, 2.0 * STEP_PERIOD_S)
        self._enter("step", STEP_PERIOD_S)
        self.glide = Glide(start, end, rates, end_rates, STEP_PERIOD_S)
        self.sway = Sway.over(-step.side)

    def _plan_after(self, step: Step) -> Step | None:
        """The step after one: on towards the intent, closing up, or none."""
        if not is_done(self._intent, step.base):
            return self._towards(-step.side, step.base)
        parallel = landing(step.base, -step.side)
        if max(abs(a - b) for a, b in zip(parallel, self.feet[-step.side], strict=True)) < 1e-9:
            return None
        return Step(-step.side, step.base, parallel)

    def _towards(self, side: int, base: Pose) -> Step:
        ahead = compose(base, next_step(self._intent, base, side))
        return Step(side, ahead, landing(ahead, side))

    def _come_to_rest(self, duration: float) -> None:
        here = self.glide.pose(self.elapsed_s if self.phase == "start" else self.duration_s)
        sway, rate = self.sway.at(self.elapsed_s if self.phase == "start" else self.duration_s)
        end = midway(self.feet[1], self.feet[-1])
        rates = ORIGIN if self.phase == "start" else self.glide.end_rates
        self.step = self._following = None
        self._enter("end", duration)
        self.glide = Glide(here, end, rates, ORIGIN, duration)
        self.sway = Sway.settle(sway, rate, duration)
