"""The short table a person reads after an experiment."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence

from naod.experiment.approach_run import Outcome
from naod.experiment.summary import LocalisationRow


def outcome_table(title: str, outcome: Outcome) -> str:
    """A few aligned lines about an approach."""
    summary, error = outcome.summary, outcome.summary.final_error
    rows = [
        ("converged", "yes" if summary.converged else "no"),
        (
            "final error",
            f"{1000 * error.position_m:.1f} mm, {math.degrees(error.yaw_rad):+.2f} deg",
        ),
        ("moves", f"{summary.moves} in {summary.time_s:.1f} s, lost {summary.lost_count} times"),
    ]
    rows += [
        (f"distance error, {label}", f"{1000 * value:.1f} mm (median of {count} looks)")
        for label, value, count in _medians(summary.localisation)
    ]
    width = max(len(name) for name, _ in rows)
    return "\n".join([title, *(f"  {name:<{width}}  {text}" for name, text in rows)])


def _medians(rows: Sequence[LocalisationRow]) -> list[tuple[str, float, int]]:
    found = []
    for label, name in (("exact", "estimated"), ("as printed", "paper")):
        errors = [
            abs(ego.rho_m - row.true.rho_m)
            for row in rows
            if (ego := getattr(row, name)) is not None
        ]
        if errors:
            found.append((label, statistics.median(errors), len(errors)))
    return found
