"""`naod ctl watch` and `naod ctl start --wait`: following what the robot does."""

from __future__ import annotations

import argparse
import json
import math
import queue
import sys
import time
from functools import partial
from typing import Any

from naod.bus import keys
from naod.bus.client import Client
from naod.cli.ctl_verbs import open_for, seconds_of
from naod.cli.output import Progress, print_json
from naod.errors import InputError
from naod.messages import GoalCall

FOLLOWED = (keys.STATE, keys.WALK_STATE, keys.EVENT, keys.DIAGNOSTICS)
SILENCE_S = 3.0
"""A daemon that has said nothing for so long is gone."""

APPROACH_S = 300.0
LINE_EVERY_S = 1.0

_News = tuple[str, dict[str, Any]]


class Follower:
    """What comes in on some names, in order, with a limit on silence."""

    def __init__(self, client: Client, names: tuple[str, ...]) -> None:
        self._client = client
        self._news: queue.SimpleQueue[_News] = queue.SimpleQueue()
        for name in names:
            client.listen(name, partial(self._take, name))

    def next(self, deadline: float) -> _News | None:
        """The next message; None at the deadline. Raises InputError after too long a silence."""
        left = deadline - time.monotonic()
        if left <= 0.0:
            return None
        try:
            return self._news.get(timeout=min(left, SILENCE_S))
        except queue.Empty:
            if left <= SILENCE_S:
                return None
            raise InputError(f"robot {self._client.robot!r} has fallen silent") from None

    def _take(self, name: str, payload: bytes) -> None:
        try:
            message = json.loads(payload)
        except ValueError:
            return
        if isinstance(message, dict):
            self._news.put((name, message))


def watch(args: argparse.Namespace) -> int:
    """Print what happens."""
    deadline = math.inf if args.seconds is None else time.monotonic() + seconds_of(args)
    with open_for(args) as client:
        follower = Follower(client, FOLLOWED)
        client.call("watch")
        printer = _print_json if args.json else Lines().show
        while (news := follower.next(deadline)) is not None:
            printer(*news)
    return 0


def start(args: argparse.Namespace) -> int:
    """Start an approach; with --wait, see it through: 0 reached, 1 not."""
    with open_for(args) as client:
        follower = Follower(client, (keys.STATE, keys.EVENT)) if args.wait else None
        answer = client.call("start", GoalCall(goal=args.goal))
        if follower is None:
            print_json(answer) if args.json else print(f"on the way to {args.goal}")
            return 0
        limit_s = APPROACH_S if args.seconds is None else seconds_of(args)
        try:
            phase, why = _see_through(follower, args.goal, time.monotonic() + limit_s)
        except KeyboardInterrupt:
            # whoever waits and then does not want to is taken to mean the robot
            client.call("stop")
            print("stopped", file=sys.stderr)
            raise
    if args.json:
        print_json({"ok": True, "goal": args.goal, "phase": phase, "message": why})
    else:
        print(why or phase)
    return 0 if phase == "reached" else 1


def _see_through(follower: Follower, goal: str, deadline: float) -> tuple[str, str]:
    """Follow an approach to its end: the last phase, and the event that told of it."""
    progress, begun, why = Progress(f"to {goal}"), False, ""
    try:
        while (news := follower.next(deadline)) is not None:
            name, message = news
            if name == keys.EVENT:
                if message["kind"] in ("reached", "failed", "stopped", "estop"):
                    why = str(message["message"])
                continue
            progress.tick(str(message["phase"]))
            ours = message["mode"] == "approach" and message["goal"] == goal
            begun = begun or ours
            if begun and not ours:
                # the event of the end is published right after the state that shows it
                return str(message["phase"]), why or _last_words(follower)
    finally:
        progress.done()
    return "timeout", "not there in time; the approach goes on"


def _last_words(follower: Follower) -> str:
    deadline = time.monotonic() + 0.5
    while (news := follower.next(deadline)) is not None:
        if news[0] == keys.EVENT and news[1]["kind"] in ("reached", "failed", "stopped", "estop"):
            return str(news[1]["message"])
    return ""


def _print_json(name: str, message: dict[str, Any]) -> None:
    print_json({"key": name, **message})


class Lines:
    """One line for every event, every change of state, and otherwise every second."""

    def __init__(self) -> None:
        self._walk: dict[str, Any] = {}
        self._shown: tuple[object, ...] = ()
        self._next = 0.0

    def show(self, name: str, message: dict[str, Any]) -> None:
        """Print it if it is worth a line."""
        if name == keys.EVENT:
            print(f"  {message['kind']}: {message['message']}", flush=True)
        elif name == keys.WALK_STATE:
            self._walk = message
        elif name == keys.STATE:
            self._show_state(message)

    def _show_state(self, state: dict[str, Any]) -> None:
        found = state["target"]["found"]
        telling = (state["mode"], state["phase"], state["goal"], found, *state["faults"])
        now = time.monotonic()
        if telling == self._shown and now < self._next:
            return
        self._shown, self._next = telling, now + LINE_EVERY_S
        print(state_line(state, self._walk), flush=True)


def state_line(state: dict[str, Any], walk: dict[str, Any]) -> str:
    """A state in one line for people."""
    words = [f"{state['mode']:<8} {state['phase']:<8}"]
    if state["goal"]:
        words.append(f"to {state['goal']}")
    ego = state["target"]["ego"]
    if state["target"]["found"] and ego:
        words.append(f"object {ego['rho_m']:.3f} m {math.degrees(ego['theta_rad']):+.1f} deg")
    else:
        words.append("no object")
    error = state["error"]
    if error:
        turn = math.degrees(error["yaw_rad"])
        words.append(f"left to go {error['x_m']:+.3f} m {error['y_m']:+.3f} m {turn:+.1f} deg")
    if walk.get("moving"):
        words.append("walking")
    if walk.get("held_by"):
        words.append(f"held by {walk['held_by']}")
    if walk.get("refused"):
        words.append(f"refused: {walk['refused']}")
    if state["faults"]:
        words.append("faults: " + ", ".join(state["faults"]))
    return "  ".join(words)
