"""`naod robot`: the simulated robot as a peer that speaks a real one's protocol."""

from __future__ import annotations

import argparse
import signal
import threading
from pathlib import Path
from types import FrameType
from typing import get_args

from hal.backends import PEERS, OpenOptions, speak
from hal.errors import ScenarioError
from hal.nao.cameras import SIZES
from hal.scenario import Scenario
from hal.types import CameraName
from naod.cli.output import print_json
from naod.errors import InputError
from naod.files import read_toml

ADDRESSES = {"lola": "/tmp/robocup", "naoqi": "tcp://127.0.0.1:9559"}
"""Where the real ones listen."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's arguments."""
    protocols = sorted(PEERS)
    parser.add_argument("--speak", required=True, choices=protocols, help="the protocol")
    parser.add_argument("--scenario", type=Path, metavar="FILE", help="its world; else the can's")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="default: 0")
    parser.add_argument(
        "--socket", metavar="PATH", help=f"lola: where to listen; default: {ADDRESSES['lola']}"
    )
    parser.add_argument(
        "--url", metavar="URL", help=f"naoqi: where to listen; default: {ADDRESSES['naoqi']}"
    )
    parser.add_argument(
        "--camera",
        metavar="PATH|PORT",
        help="lola: serve the camera's pictures on this socket or loopback port too",
    )
    parser.add_argument("--which", choices=get_args(CameraName), default="top", help="the camera")
    parser.add_argument("--size", default="640x480", metavar="WxH", help="default: 640x480")
    parser.add_argument("--fps", type=int, default=15, metavar="N", help="default: 15")
    parser.add_argument("--json", action="store_true", help="say where it listens as JSON")


def run(args: argparse.Namespace) -> int:
    """Serve until SIGINT or SIGTERM: exit status 0. Raises InputError, BackendError."""
    if args.seed < 0:
        raise InputError(f"--seed {args.seed}: must not be negative")
    address = _address(args)
    options = _options(args)
    stop = threading.Event()

    def end(_number: int, _frame: FrameType | None) -> None:
        stop.set()

    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, end)

    def ready(served: dict[str, object]) -> None:
        _tell(served, as_json=args.json)

    try:
        speak(args.speak, options, address, args.camera, stop, ready)
    except ScenarioError as error:
        where = f"{args.scenario}: " if args.scenario else ""
        raise InputError(f"{where}{error}") from None
    return 0


def _address(args: argparse.Namespace) -> str:
    """Where to listen; an option of the other protocol is a mistake."""
    given = {"lola": args.socket, "naoqi": args.url}
    flags = {"lola": "--socket", "naoqi": "--url"}
    for protocol, value in given.items():
        if value is not None and protocol != args.speak:
            raise InputError(f"{flags[protocol]}: is for --speak {protocol}")
    return str(given[args.speak] or ADDRESSES[args.speak])


def _options(args: argparse.Namespace) -> OpenOptions:
    width, _, height = args.size.partition("x")
    if not (width.isdecimal() and height.isdecimal()) or (int(width), int(height)) not in SIZES:
        known = ", ".join(f"{w}x{h}" for w, h in SIZES)
        raise InputError(f"--size {args.size}: not of {known}")
    scenario = read_toml(args.scenario, Scenario) if args.scenario else None
    folder = args.scenario.resolve().parent if args.scenario else Path.cwd()
    section: dict[str, object] = {
        "scenario": scenario,
        "scenario_folder": folder,
        "seed": args.seed,
        "real_time": True,
    }
    return OpenOptions(
        name="simulated",
        camera=args.which,
        width=int(width),
        height=int(height),
        fps=args.fps,
        section=section,
    )


def _tell(served: dict[str, object], *, as_json: bool) -> None:
    if as_json:
        print_json(served)
        return
    for key, value in served.items():
        print(f"{key}: {value}", flush=True)
