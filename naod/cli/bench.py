"""`naod bench`: ours beside its peers, in one run."""

from __future__ import annotations

import argparse
from pathlib import Path

import msgspec

from naod.bench.plot import plot
from naod.bench.table import BENCHES, QUICK, as_text, bench
from naod.cli.output import Progress, print_json
from naod.errors import InputError

TEXT = f"of {', '.join(BENCHES)}; default: {', '.join(QUICK)}"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's arguments."""
    parser.add_argument("names", nargs="*", metavar="NAME", help=TEXT)
    parser.add_argument("--plot", type=Path, metavar="FILE.png", help="the last one as a picture")
    parser.add_argument("--json", action="store_true", help="print one JSON document")


def run(args: argparse.Namespace) -> int:
    """Exit status 0 when all ran."""
    names = args.names or list(QUICK)
    unknown = [name for name in names if name not in BENCHES]
    if unknown:
        raise InputError(f"no benchmark {unknown[0]!r}; there are: {', '.join(sorted(BENCHES))}")
    reports = []
    for name in names:
        progress = Progress(name)
        reports.append(bench(name, progress.tick))
        progress.done()
        if not args.json:
            print(as_text(reports[-1]))
    if args.plot is not None:
        plot(reports[-1], args.plot)
    if args.json:
        print_json({"benches": [msgspec.to_builtins(report) for report in reports]})
    return 0
