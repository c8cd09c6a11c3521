"""`naod doctor`: what is well, what is not, and what to do about it."""

from __future__ import annotations

import argparse
from pathlib import Path

import msgspec

from hal.health import Finding
from naod.cli.output import Progress, print_json
from naod.config import load_config
from naod.doctor.examination import examination


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command line of `naod doctor`."""
    parser.add_argument("--config", type=Path, metavar="FILE", help="default: a simulated robot")
    parser.add_argument("--json", action="store_true", help="one JSON document on stdout")


def run(args: argparse.Namespace) -> int:
    """Exit status 0 if nothing fails, 1 if something does. Raises InputError."""
    config = load_config(args.config)
    source = "no file" if args.config is None else str(args.config)
    beside = Path.cwd() if args.config is None else args.config.resolve().parent
    progress = Progress("examining")
    found = []
    for finding in examination(config, source, beside):
        found.append(finding)
        progress.tick(finding.check)
        if not args.json:
            progress.done()
            print(_line(finding), flush=True)
    progress.done()
    failed = any(finding.status == "fail" for finding in found)
    if args.json:
        print_json({"ok": not failed, "findings": msgspec.to_builtins(found)})
    return 1 if failed else 0


def _line(finding: Finding) -> str:
    advice = f" -> {finding.advice}" if finding.advice else ""
    return f"{finding.status:<5} {finding.check}: {finding.text}{advice}"
