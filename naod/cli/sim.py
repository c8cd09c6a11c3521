"""`naod sim`: one scenario in lock-step, deterministic for a seed."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import msgspec

from hal.errors import ScenarioError
from naod.cli.demo import make_folder
from naod.cli.output import Progress, print_json
from naod.config import DaemonConfig
from naod.errors import InputError
from naod.experiment.approach_run import Experiment, Outcome
from naod.experiment.opening import load_scenario, open_lockstep
from naod.experiment.table import outcome_table
from naod.files import write_whole

POLICIES = ("look-then-move",)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's arguments."""
    parser.add_argument("scenario", type=Path, metavar="SCENARIO.toml")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="default: 0")
    parser.add_argument("--policy", default=POLICIES[0], metavar="NAME", help=", ".join(POLICIES))
    parser.add_argument("--out", type=Path, metavar="DIR", help="write summary.json there")
    parser.add_argument("--json", action="store_true", help="print the summary as JSON")


def run(args: argparse.Namespace) -> int:
    """Exit status 0 if the robot believes it arrived, 1 if not."""
    if args.seed < 0:
        raise InputError(f"--seed {args.seed}: must not be negative")
    if args.policy not in POLICIES:
        raise InputError(f"--policy {args.policy}: unknown; known: {', '.join(POLICIES)}")
    folder = make_folder(args.out) if args.out else None
    outcome = _simulate(args.scenario, args.seed)
    document = msgspec.to_builtins(outcome.summary)
    if folder is not None:
        text = msgspec.json.format(msgspec.json.encode(document), indent=1)
        write_whole(folder / "summary.json", text + b"\n")
    if args.json:
        print_json(document)
    else:
        print(outcome_table(f"{args.scenario.name}, seed {args.seed}", outcome))
    if outcome.reason:
        print(f"naod sim: {outcome.reason}", file=sys.stderr)
    return 0 if outcome.summary.converged else 1


def _simulate(path: Path, seed: int) -> Outcome:
    scenario = load_scenario(path)
    config = DaemonConfig()
    try:
        lockstep = open_lockstep(config, scenario, path.resolve().parent, seed, compare_paper=True)
    except ScenarioError as error:
        raise InputError(f"{path}: {error}") from None
    try:
        progress = Progress(path.name)
        lockstep.listeners.append(lambda tick: progress.tick(tick.commands.state.phase))
        experiment = Experiment(lockstep, seed)
        shown = experiment.demonstrate()
        experiment.carry_to_start()
        outcome = experiment.approach(shown)
        progress.done()
    finally:
        lockstep.robot.close()
    return outcome
