"""A benchmark's report as a picture: overlap at each exposure, and time."""

from __future__ import annotations

from pathlib import Path

from naod.bench.table import Report
from naod.errors import InputError

IOU = "box IoU "
COLOURS = ("#2b6cb0", "#63b3ed", "#bee3f8")


def plot(report: Report, path: Path) -> None:
    """Write PNG. Raises InputError where there is nothing to draw, or no way to."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise InputError("a plot needs matplotlib, which is not installed") from None
    rows = [row for row in report.rows if isinstance(row[1], float)]
    blurs = [i for i, column in enumerate(report.columns) if column.startswith(IOU)]
    if not blurs:
        raise InputError(f"--plot: {report.name} has no overlaps to draw")
    names = [str(row[0]) for row in rows]
    figure = Figure(figsize=(11.0, 0.45 * len(rows) + 1.2), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2, sharey=True)
    for n, column in enumerate(blurs):
        values = [_number(row[column]) for row in rows]
        places = [i + 0.25 * (n - 1) for i in range(len(rows))]
        label = report.columns[column].removeprefix(IOU)
        left.barh(places, values, 0.25, label=label, color=COLOURS[n % len(COLOURS)])
    left.set_yticks(range(len(rows)), names)
    left.invert_yaxis()
    left.set_xlim(0.0, 1.0)
    left.set_xlabel("median IoU of the box, by exposure")
    left.legend(loc="lower right")
    right.barh(range(len(rows)), [_number(row[1]) for row in rows], color=COLOURS[0])
    right.set_xscale("log")
    right.set_xlabel("median time per frame, ms")
    try:
        figure.savefig(str(path), format="png", dpi=110)
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from None


def _number(value: str | float | int | None) -> float:
    return float(value) if isinstance(value, (int, float)) else 0.0
