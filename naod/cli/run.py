"""`naod run`: the daemon."""

from __future__ import annotations

import argparse
from pathlib import Path

from naod.config import load_config


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command line of `naod run`."""
    parser.add_argument(
        "--config",
        type=Path,
        metavar="FILE",
        help="configuration; without it, a robot in simulation",
    )


def run(args: argparse.Namespace) -> int:
    """Run the daemon until it is told to stop. Raises InputError, HalError."""
    config = load_config(args.config)
    from naod.daemon.process import run_daemon

    return run_daemon(config, args.config.parent if args.config else Path.cwd())
