"""The demo's approaches for ten seeds each: who arrives, how near, and how well it localised."""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable
from pathlib import Path

from naod.bench.table import Report
from naod.config import DaemonConfig
from naod.experiment.approach_run import Experiment
from naod.experiment.opening import open_lockstep
from naod.experiment.scenarios import DemoObject, demo_scenario
from naod.experiment.summary import Summary

SEEDS = range(10)
OBJECTS: tuple[DemoObject, ...] = ("can", "board")
COLUMNS = (
    "object",
    "reached",
    "mm median",
    "mm worst",
    "deg worst",
    "moves",
    "s simulated",
    "rho % exact",
    "rho % printed",
)


def run(progress: Callable[[str], None]) -> Report:
    """All seeds of both objects; the errors are the simulator's truth."""
    rows = []
    for name in OBJECTS:
        summaries = []
        for seed in SEEDS:
            progress(f"{name}, seed {seed}")
            summaries.append(one(name, seed))
        rows.append(_row(name, summaries))
    notes = (
        "mm, deg: base against the pose shown; for the can, against the nearest on its circle",
        "rho %: median error of the distance, of the distance",
    )
    return Report("approach", COLUMNS, tuple(rows), notes)


def one(name: DemoObject, seed: int) -> Summary:
    """One demonstration and approach, as `naod demo` does them, without its pictures."""
    scenario = demo_scenario(name, seed)
    lockstep = open_lockstep(DaemonConfig(), scenario, Path(), seed, compare_paper=True)
    try:
        experiment = Experiment(lockstep, seed)
        shown = experiment.demonstrate()
        experiment.carry_to_start()
        return experiment.approach(shown).summary
    finally:
        lockstep.robot.close()


def _row(name: str, summaries: list[Summary]) -> tuple[str | float | int | None, ...]:
    errors = [summary.final_error for summary in summaries]
    reached = sum(s.converged and s.final_error.reached for s in summaries)
    return (
        name,
        f"{reached}/{len(summaries)}",
        1000.0 * statistics.median(e.position_m for e in errors),
        1000.0 * max(e.position_m for e in errors),
        math.degrees(max(abs(e.yaw_rad) for e in errors)),
        statistics.median(s.moves for s in summaries),
        statistics.median(s.time_s for s in summaries),
        _distance_error(summaries, "estimated"),
        _distance_error(summaries, "paper"),
    )


def _distance_error(summaries: list[Summary], which: str) -> float:
    rows = [row for summary in summaries for row in summary.localisation]
    return statistics.median(
        100.0 * abs(ego.rho_m - row.true.rho_m) / row.true.rho_m
        for row in rows
        if (ego := getattr(row, which)) is not None
    )
