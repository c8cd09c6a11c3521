"""`naod ctl walk` and `naod ctl head`: commands that end by themselves unless renewed."""

from __future__ import annotations

import argparse
import math
import os
import socket
import time
from typing import Any

from naod.bus import keys
from naod.bus.client import Client
from naod.cli.ctl_verbs import open_for, seconds_of
from naod.cli.output import Progress, print_json
from naod.errors import InputError
from naod.geometry.transforms import inverse, planar, yaw_of
from naod.messages import HeadCommand, WalkCommand

RENEW_S = 0.1
WALK_TTL_MS = 300
HEAD_TTL_MS = 1000
STANDING_S = 2.0


def walk(args: argparse.Namespace) -> int:
    """Walk for some seconds, then stop; also when interrupted."""
    seconds = seconds_of(args)
    for name in ("vx", "vy", "wz"):
        _finite(name.upper(), getattr(args, name))
    with open_for(args) as client:
        before = client.call("status")["walk"]["odometry"]
        _drive(client, args, seconds)
        state = _standing(client)
    if args.json:
        print_json({"ok": True, "walk": state})
    else:
        x, y, turn = _between(before, state["odometry"])
        print(f"stopped after {x:+.3f} m, {y:+.3f} m, {math.degrees(turn):+.1f} deg")
    return 0


def head(args: argparse.Namespace) -> int:
    """Turn the head and hold it for some seconds."""
    seconds = seconds_of(args)
    yaw, pitch = (math.radians(_finite(n.upper(), getattr(args, n))) for n in ("yaw", "pitch"))
    source, end = _source(), time.monotonic() + seconds
    with open_for(args) as client:
        while True:
            left_ms = max(1, min(HEAD_TTL_MS, round((end - time.monotonic()) * 1000)))
            call = HeadCommand(
                source=source, seq=time.time_ns(), yaw=yaw, pitch=pitch, ttl_ms=left_ms
            )
            answer = client.call("head", call)
            if left_ms < HEAD_TTL_MS:
                time.sleep(left_ms / 1000)
                break
            time.sleep(HEAD_TTL_MS / 3000)
    if args.json:
        print_json(answer)
    else:
        sent = [math.degrees(answer[name]) for name in ("yaw", "pitch")]
        print(f"head at {sent[0]:+.1f}, {sent[1]:+.1f} deg (after limits)")
    return 0


def _drive(client: Client, args: argparse.Namespace, seconds: float) -> None:
    source, end = _source(), time.monotonic() + seconds
    progress = Progress("walking")

    def command(kind: str) -> WalkCommand:
        return WalkCommand(
            source=source,
            seq=time.time_ns(),
            kind="velocity" if kind == "velocity" else "stop",
            x=args.vx,
            y=args.vy,
            yaw=args.wz,
            ttl_ms=WALK_TTL_MS,
        )

    # the first by call, for its answer says whether it is taken at all
    client.call("walk", command("velocity"))
    try:
        due = time.monotonic() + RENEW_S
        while due < end:
            time.sleep(max(0.0, due - time.monotonic()))
            client.publish(keys.WALK_COMMAND, command("velocity"))
            progress.tick()
            due += RENEW_S
        time.sleep(max(0.0, end - time.monotonic()))
    finally:
        progress.done()
        client.call("walk", command("stop"))


def _standing(client: Client) -> dict[str, Any]:
    """The walk's state once the robot stands, or after the time in which it has to."""
    deadline = time.monotonic() + STANDING_S
    while True:
        state: dict[str, Any] = client.call("status")["walk"]
        if not state["moving"] or time.monotonic() > deadline:
            return state
        time.sleep(RENEW_S)


def _between(before: list[float], after: list[float]) -> tuple[float, float, float]:
    """From one odometry pose to another, as seen from the first."""
    T = inverse(planar(*before)) @ planar(*after)
    return float(T[0, 3]), float(T[1, 3]), yaw_of(T)


def _source() -> str:
    """Who drives, told apart from every other `naod ctl`."""
    name = f"{os.environ.get('USER', 'uid' + str(os.getuid()))}@{socket.gethostname()}"
    printable = "".join(c for c in name if c.isprintable())
    return f"{printable[:48]}:{os.getpid()}"


def _finite(name: str, value: float) -> float:
    if not math.isfinite(value):
        raise InputError(f"{name} is not a finite number")
    return value
