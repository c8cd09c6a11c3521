"""The benchmarks by name. One is imported only when it is asked for.

Each module has `run(progress) -> Report`.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import cast

import msgspec

from naod.errors import InputError

BENCHES: dict[str, str] = {
    "perception": "naod.bench.perception",
    "approach": "naod.bench.approach",
    "rooms": "naod.bench.rooms",
    "poses": "naod.bench.poses",
    "backdrops": "naod.bench.backdrops",
    "lola": "naod.bench.lola",
    "portable": "naod.bench.portable",
}

QUICK = ("perception",)
"""Run when no name is given; the others take minutes."""


Cell = str | float | int | None


class Report(msgspec.Struct, frozen=True):
    """What a benchmark found: a table for people, the same as data for programs.

    `further`: more tables of the same run.
    """

    name: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    notes: tuple[str, ...] = ()
    further: tuple[Report, ...] = ()


def bench(name: str, progress: Callable[[str], None]) -> Report:
    """Run one by name. Raises InputError for one that there is not."""
    if name not in BENCHES:
        raise InputError(f"no benchmark {name!r}; there are: {', '.join(sorted(BENCHES))}")
    module = importlib.import_module(BENCHES[name])
    return cast(Report, module.run(progress))


def as_text(report: Report) -> str:
    """The report and those further ones as aligned columns."""
    cells = [list(report.columns), *([_cell(value) for value in row] for row in report.rows)]
    widths = [max(len(row[i]) for row in cells) for i in range(len(report.columns))]
    lines = [report.name]
    for row in cells:
        first, *rest = (
            text.ljust(width) if i == 0 else text.rjust(width)
            for i, (text, width) in enumerate(zip(row, widths, strict=True))
        )
        lines.append("  " + "  ".join([first, *rest]).rstrip())
    lines += [f"  {note}" for note in report.notes]
    return "\n".join(lines) + "".join(f"\n\n{as_text(other)}" for other in report.further)


def _cell(value: Cell) -> str:
    if value is None:
        return "-"
    return f"{value:.3g}" if isinstance(value, float) else str(value)
