"""Verbs of `naod ctl` that are one call and one answer."""

from __future__ import annotations

import argparse
import base64
import math
from typing import Any

from naod.bus.client import Client
from naod.cli.output import Progress, print_json
from naod.errors import InputError
from naod.files import write_whole
from naod.messages import GoalCall, LabelCall, Message

LEARNING_S = 35.0
"""Teaching waits for the object to be seen centred, up to 20 s."""

SECONDS_MAX = 86400.0

DONE = {
    "stop": "stopped",
    "estop": "stopped and latched; `naod ctl release` lets go",
    "release": "released",
}


def open_for(args: argparse.Namespace) -> Client:
    """The robot that the command line names."""
    return Client(args.connect, args.robot)


def seconds_of(args: argparse.Namespace) -> float:
    """The seconds after --for. Raises InputError."""
    seconds = float(args.seconds)
    if not 0.0 < seconds <= SECONDS_MAX:
        raise InputError(f"--for {seconds:g}: give seconds, more than 0, at most {SECONDS_MAX:g}")
    return seconds


def simple(args: argparse.Namespace) -> int:
    """stop, estop, release."""
    answer = _asked(args, args.verb)
    text = DONE[args.verb]
    warning = answer.get("warning")
    return _show(args, answer, f"{text}; {warning}" if warning else text)


def status(args: argparse.Namespace) -> int:
    """Everything there is to know at once."""
    answer = _asked(args, "status")
    return _show(args, answer, _status_text(answer))


def goals(args: argparse.Namespace) -> int:
    """The goals by name."""
    answer = _asked(args, "goals")
    lines = [
        f"{g['name']:<16} {g['kind']:<10} {g['rho_m']:.3f} m away, "
        f"{math.degrees(g['theta_rad']):+.1f} deg to the side, seen to {g['sigma_m'] * 1e3:.1f} mm"
        for g in answer["goals"]
    ]
    return _show(args, answer, "\n".join(lines) or "no goal was taught yet")


def picture(args: argparse.Namespace) -> int:
    """Keep what the robot sees."""
    if args.file.suffix.lower() not in (".jpg", ".jpeg"):
        raise InputError(f"{args.file}: the picture is a JPEG, give a name that ends in .jpg")
    answer = _asked(args, "picture")
    write_whole(args.file, base64.b64decode(answer["jpeg"]))
    size = f"{answer['width']}x{answer['height']}"
    shown = {"ok": True, "file": str(args.file), "stamp_ns": answer["stamp_ns"]}
    return _show(args, shown, f"{args.file}: {size} pixels; label X,Y,W,H counts from top left")


def label(args: argparse.Namespace) -> int:
    """Learn the colour."""
    call = _region(args.region)
    answer = _asked(args, "label", call, LEARNING_S)
    doubt = answer.get("message")
    text = "colour learnt and kept"
    return _show(args, answer, f"{text}, but {doubt}" if doubt else text)


def teach(args: argparse.Namespace) -> int:
    """Remember the pose."""
    answer = _asked(args, "teach", _goal(args.goal), LEARNING_S)
    return _show(args, answer, f"goal {args.goal} learnt and kept")


def _goal(name: str) -> GoalCall:
    if not 1 <= len(name) <= 64:
        raise InputError("a goal's name has 1 to 32 letters, digits, - or _")
    return GoalCall(goal=name)


def _region(text: str) -> LabelCall:
    try:
        x, y, width, height = (int(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"region {text!r}: give X,Y,W,H as four whole numbers") from None
    if min(x, y) < 0 or min(width, height) < 1 or max(x, y, width, height) > 4096:
        raise InputError(f"region {text!r}: is not a part of a picture")
    return LabelCall(x=x, y=y, width=width, height=height)


def _asked(
    args: argparse.Namespace, verb: str, message: Message | None = None, timeout_s: float = 2.5
) -> dict[str, Any]:
    progress = Progress(f"waiting for {verb}")
    with open_for(args) as client:
        # a robot that is not there is told apart from one that takes its time
        if timeout_s > 3.0:
            client.call("goals")
        try:
            return client.call(verb, message, timeout_s, progress.tick)
        finally:
            progress.done()


def _show(args: argparse.Namespace, answer: dict[str, Any], text: str) -> int:
    if args.json:
        print_json(answer)
    else:
        print(text)
    return 0


def _status_text(answer: dict[str, Any]) -> str:
    robot, state, walk = answer["robot"], answer["state"], answer["walk"]
    lines = [f"robot     {robot['name']}, {robot['version']}, {robot['backend']}"]
    lines.append(f"naod      {answer['version']}")
    lines.append(f"colour    {'learnt' if answer['labelled'] else 'not learnt'}")
    lines.append(f"goals     {', '.join(answer['goals']) or 'none'}")
    if answer["estopped"]:
        lines.append("estop     latched")
    if state:
        goal = f" to {state['goal']}" if state["goal"] else ""
        lines.append(f"state     {state['mode']}{goal}, {state['phase']}")
        lines.append(f"faults    {', '.join(state['faults']) or 'none'}")
    if walk:
        lines.append(f"walk      {_walk_text(walk)}")
    timing = answer["diagnostics"]
    if timing:
        lines.append(
            f"loop      {timing['period_ms']:.1f} ms, jitter {timing['jitter_ms']:.1f} ms, "
            f"latency {timing['latency_ms']:.0f} ms, {timing['overruns']} overruns"
        )
        lines.append(f"battery   {100 * timing['battery']:.0f} %")
    return "\n".join(lines)


def _walk_text(walk: dict[str, Any]) -> str:
    words = ["fallen" if walk["fallen"] else "moving" if walk["moving"] else "standing"]
    if walk["held_by"]:
        words.append(f"held by {walk['held_by']}")
    if walk["refused"]:
        words.append(f"refused: {walk['refused']}")
    return ", ".join(words)
