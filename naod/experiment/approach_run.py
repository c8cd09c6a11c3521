"""The paper's experiment: shown once, started elsewhere, walked there by sight (5.2)."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field

from hal.scenario import Scenario
from hal.simulation import SimulatedRobot, Truth
from hal.types import Frame, PlanarMotion
from naod.approach.displacement import shape_kind
from naod.approach.goal import Goal
from naod.errors import InputError
from naod.experiment.lockstep import LockStep, Tick
from naod.experiment.person import mark, point_head
from naod.experiment.summary import (
    LocalisationRow,
    Summary,
    ego_row,
    final_error,
    true_ego,
)
from naod.geometry.transforms import wrap
from naod.loop.equipment import Sighting
from naod.loop.types import Label, Start, Teach

GOAL = "demonstrated"
STAND_S = 1.5
"""Time given to a robot that was just put down, and one that has arrived."""


@dataclass(slots=True)
class Journal:
    """What is kept of an approach; `sights` holds a picture and what was seen in it per stance."""

    rows: list[LocalisationRow] = field(default_factory=list)
    way: list[Truth] = field(default_factory=list)
    sights: list[tuple[Frame, Sighting | None]] = field(default_factory=list)
    start_ns: int = 0

    def note(self, tick: Tick) -> None:
        """Listen to a tick of the approach."""
        self.way.append(tick.truth)
        sighting, frame = tick.sighting, tick.seen.frame
        if sighting is None or frame is None or sighting.look is None:
            return
        decided = tick.commands.walk is not None or tick.state.phase == "reached"
        looks = tick.state.looks
        if decided or (looks and looks[-1] is sighting.look):
            self._add_row(tick, sighting)
        if decided:
            self.sights.append((frame, sighting))

    def _add_row(self, tick: Tick, sighting: Sighting) -> None:
        if sighting.look is None:
            return
        row = LocalisationRow(
            t_s=(tick.now_ns - self.start_ns) / 1e9,
            estimated=ego_row(sighting.look.ego),
            true=ego_row(true_ego(tick.truth)),
            paper=ego_row(sighting.paper) if sighting.paper else None,
        )
        self.rows.append(row)


@dataclass(frozen=True, slots=True)
class Outcome:
    """An approach and everything that was noted of it; `reason` says why it was not reached."""

    summary: Summary
    journal: Journal
    shown: Truth
    goal: Goal
    reason: str


class Experiment:
    """Demonstration and approach on one simulated robot, in lock-step."""

    def __init__(self, run: LockStep, seed: int) -> None:
        self.run = run
        self.seed = seed

    @property
    def scenario(self) -> Scenario:
        """The world."""
        return self.run.robot.scenario

    def demonstrate(self) -> Truth:
        """Put the robot at the goal, mark the object, show the pose. Raises InputError."""
        run = self.run
        place(run.robot, self.scenario.goal.demonstrate_at or (0.0, 0.0, 0.0))
        run.settle()
        point_head(run)
        region = mark(run.robot.truth(), run.equipment.shape, run.equipment.camera)
        self._ask(region)
        self._ask(Teach(GOAL))
        return run.robot.truth()

    def carry_to_start(self) -> None:
        """Put the robot where it is to start from."""
        place(self.run.robot, self.scenario.robot.start)
        self.run.settle()

    def approach(self, shown: Truth) -> Outcome:
        """Let the robot walk until it believes it is there, gives up, or its time is over."""
        run, journal, wall = self.run, Journal(), time.perf_counter()
        journal.start_ns = run.robot.clock.now_ns()
        run.listeners.append(journal.note)
        self._ask(Start(GOAL))
        lost_before = run.state.lost_count
        deadline_ns = journal.start_ns + int(self.scenario.limits.time_s * 1e9)
        while run.state.mode == "approach" and run.robot.clock.now_ns() < deadline_ns:
            run.tick()
        end_ns = run.robot.clock.now_ns()
        run.listeners.remove(journal.note)
        self._come_to_rest()
        truth = run.robot.truth()
        summary = Summary(
            converged=run.state.phase == "reached",
            final_error=final_error(shape_kind(run.equipment.shape), shown, truth),
            time_s=(end_ns - journal.start_ns) / 1e9,
            moves=run.state.moves,
            fell=run.robot.walk.status().fallen,
            lost_count=run.state.lost_count - lost_before,
            localisation=journal.rows,
            wall_s=time.perf_counter() - wall,
            seed=self.seed,
        )
        reason = "" if summary.converged else self._reason()
        return Outcome(summary, journal, shown, run.state.goals[GOAL], reason)

    def _reason(self) -> str:
        failed = [event.message for event in self.run.events if event.kind == "failed"]
        return failed[-1] if failed else "the time is over"

    def _come_to_rest(self) -> None:
        self.run.robot.walk.stop()
        now_ns = self.run.robot.clock.now_ns()
        self.run.robot.advance(now_ns + int(STAND_S * 1e9))

    def _ask(self, verb: Label | Teach | Start) -> None:
        reply = self.run.ask(verb)
        if reply.error_code is not None:
            name = type(verb).__name__.lower()
            raise InputError(f"{name} failed in the simulation: {reply.message}")


def place(robot: SimulatedRobot, pose_deg: tuple[float, float, float]) -> None:
    """Put the robot at x, y (m) and yaw (degrees)."""
    x, y, yaw_deg = pose_deg
    robot.place(PlanarMotion(x, y, wrap(math.radians(yaw_deg))))
