"""Entry point: finds the command, turns bad input into one line and exit status 2."""

from __future__ import annotations

import argparse
import importlib
import os
import sys
from collections.abc import Sequence

from hal.errors import HalError
from naod import __version__
from naod.errors import NaodError

COMMANDS: dict[str, str] = {
    "demo": "the whole experiment in simulation: be shown a pose, start elsewhere, walk there",
    "sim": "one scenario, in lock-step, faster than real time",
    "learn": "a colour model from marked pictures",
    "segment": "masks from pictures, folders or a video",
    "locate": "the object's pose from pictures",
    "robot": "the simulated robot as a peer that speaks LoLA or NAOqi",
    "run": "the daemon",
    "ctl": "remote control of a running daemon",
    "doctor": "what is well with the robot and this machine, what is not, and what to do",
    "calibrate": "one head's camera correction and intrinsics from a printed rectangle",
    "bench": "benchmarks, with peers in the same run",
}
"""Each lives in `naod.cli.<name>` with `add_arguments(parser)` and `run(args) -> int`."""


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> None:  # type: ignore[override]
        print(f"{self.prog}: {message}", file=sys.stderr)
        raise SystemExit(2)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command; returns its exit status."""
    words = list(sys.argv[1:] if argv is None else argv)
    command = words[0] if words and words[0] in COMMANDS else ""
    try:
        args = _build(command).parse_args(words)
        status = int(args.run(args))
        sys.stdout.flush()
    except (NaodError, HalError) as error:
        return _complain(command, str(error))
    except BrokenPipeError:
        _drop_output()
        return 0
    except OSError as error:
        _drop_output()
        return _complain(command, f"{error.filename or 'output'}: {error.strerror}")
    except KeyboardInterrupt:
        return 130
    return status


def _complain(command: str, text: str) -> int:
    print(f"naod {command}: {text}" if command else f"naod: {text}", file=sys.stderr)
    return 2


def _drop_output() -> None:
    """What is left in the buffer has nowhere to go; at exit it must not raise again."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _build(wanted: str) -> argparse.ArgumentParser:
    """The parser; only the wanted command's module is imported, so that `--help` is quick."""
    parser = _Parser(prog="naod", description="Finds an object by colour and walks a NAO to it.")
    parser.add_argument("--version", action="version", version=f"naod {__version__}")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, summary in COMMANDS.items():
        sub = commands.add_parser(name, help=summary, description=summary)
        if name == wanted:
            module = importlib.import_module(f"naod.cli.{name}")
            module.add_arguments(sub)
            sub.set_defaults(run=module.run)
    return parser


if __name__ == "__main__":
    sys.exit(main())
