"""`naod ctl`: remote control of a running daemon."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable
from pathlib import Path

from naod.cli import ctl_drive, ctl_verbs, ctl_watch

LOOPBACK = "tcp/127.0.0.1:7447"

# argparse takes -1e-3 for an option unless told what a number looks like
_NEGATIVE = re.compile(r"^-([\d.][\d.,eE+-]*|inf|nan)$")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command line of `naod ctl`."""
    _add_common(parser, LOOPBACK, "nao", False)
    verbs = parser.add_subparsers(dest="verb", metavar="VERB", required=True)

    def verb(
        name: str, text: str, carry_out: Callable[[argparse.Namespace], int]
    ) -> argparse.ArgumentParser:
        sub = verbs.add_parser(name, help=text, description=text)
        sub._negative_number_matcher = _NEGATIVE
        # the same options after the verb, without undoing those before it
        _add_common(sub, *[argparse.SUPPRESS] * 3)
        sub.set_defaults(carry_out=carry_out)
        return sub

    _add_simple(verb)
    _add_moving(verb)


def _add_common(
    parser: argparse.ArgumentParser, connect: str, robot: str, json: bool | str
) -> None:
    add = parser.add_argument
    add("--connect", default=connect, metavar="ENDPOINT", help=f"default: {LOOPBACK}")
    add("--robot", default=robot, metavar="NAME", help="default: nao")
    add("--json", action="store_true", default=json, help="answers as JSON on stdout")


def run(args: argparse.Namespace) -> int:
    """Carry out the verb. Raises InputError, CallError."""
    return int(args.carry_out(args))


_Adder = Callable[[str, str, Callable[[argparse.Namespace], int]], argparse.ArgumentParser]


def _add_simple(verb: _Adder) -> None:
    verb("status", "state, walk, timing, version and goals", ctl_verbs.status)
    watch = verb("watch", "follow state and events, until Ctrl-C", ctl_watch.watch)
    watch.add_argument(
        "--for", dest="seconds", type=float, metavar="S", help="end after so many seconds"
    )
    start = verb("start", "walk to a goal that was taught", ctl_watch.start)
    start.add_argument("goal", metavar="GOAL")
    start.add_argument(
        "--wait", action="store_true", help="until it is reached (exit 0) or not (exit 1)"
    )
    start.add_argument(
        "--for", dest="seconds", type=float, metavar="S", help="with --wait: at most so long"
    )
    verb("stop", "stop walking, whoever walks", ctl_verbs.simple)
    verb("estop", "stop, and refuse every walk until release", ctl_verbs.simple)
    verb("release", "let go of the estop; nothing moves by that", ctl_verbs.simple)
    picture = verb("picture", "keep what the robot sees, to find a region", ctl_verbs.picture)
    picture.add_argument("file", type=Path, metavar="FILE.jpg")
    label = verb("label", "learn the object's colour from a part of the picture", ctl_verbs.label)
    label.add_argument("region", metavar="X,Y,W,H", help="in pixels of the camera's picture")
    teach = verb("teach", "remember the present pose as a goal", ctl_verbs.teach)
    teach.add_argument("goal", metavar="GOAL", help="1 to 32 letters, digits, - or _")
    verb("goals", "the goals that were taught", ctl_verbs.goals)


def _add_moving(verb: _Adder) -> None:
    walk = verb("walk", "walk at a velocity, then stop", ctl_drive.walk)
    walk.add_argument("vx", type=float, metavar="VX", help="forward, m/s")
    walk.add_argument("vy", type=float, metavar="VY", help="to the left, m/s")
    walk.add_argument("wz", type=float, metavar="WZ", help="turning left, rad/s")
    walk.add_argument(
        "--for", dest="seconds", type=float, default=1.0, metavar="S", help="seconds; default: 1"
    )
    head = verb("head", "turn the head and hold it there", ctl_drive.head)
    head.add_argument("yaw", type=float, metavar="YAW", help="to the left, degrees")
    head.add_argument("pitch", type=float, metavar="PITCH", help="downwards, degrees")
    head.add_argument(
        "--for", dest="seconds", type=float, default=1.0, metavar="S", help="seconds; default: 1"
    )
