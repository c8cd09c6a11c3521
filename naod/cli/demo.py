"""`naod demo`: the paper's experiment in simulation, from being shown to standing there."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import msgspec

from naod.cli.output import Progress, print_json
from naod.config import DaemonConfig
from naod.errors import InputError
from naod.experiment.approach_run import Experiment, Outcome
from naod.experiment.lockstep import LockStep
from naod.experiment.opening import open_lockstep
from naod.experiment.scenarios import DemoObject, demo_scenario
from naod.experiment.table import outcome_table


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's arguments."""
    parser.add_argument("--object", choices=("can", "board"), default="can", help="default: can")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="default: 0")
    parser.add_argument(
        "--out", type=Path, default=Path("demo-out"), metavar="DIR", help="default: demo-out"
    )
    parser.add_argument("--json", action="store_true", help="print the summary as JSON")


def run(args: argparse.Namespace) -> int:
    """Exit status 0 only if the pose shown was reached, in truth and in the program's belief."""
    if args.seed < 0:
        raise InputError(f"--seed {args.seed}: must not be negative")
    folder = make_folder(args.out)
    name: DemoObject = args.object
    scenario = demo_scenario(name, args.seed)
    lockstep = open_lockstep(DaemonConfig(), scenario, Path(), args.seed, compare_paper=True)
    try:
        outcome = _perform(lockstep, args.seed, folder)
    finally:
        lockstep.robot.close()
    if args.json:
        print_json(msgspec.to_builtins(outcome.summary))
    else:
        print(outcome_table(f"{name}, seed {args.seed}", outcome))
        print(f"figures, frames, film and recording: {folder}/")
    reached = outcome.summary.converged and outcome.summary.final_error.reached
    if not reached:
        why = f": {outcome.reason}" if outcome.reason else ""
        print(f"naod demo: the pose shown was not reached{why}", file=sys.stderr)
    return 0 if reached else 1


def make_folder(path: Path) -> Path:
    """The folder, made if need be. Raises InputError."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"--out {path}: {error.strerror}") from None
    return path


def _perform(lockstep: LockStep, seed: int, folder: Path) -> Outcome:
    # matplotlib and mcap are slow to import and needed only here
    try:
        from naod.experiment.recording import Recorder
        from naod.experiment.report import ROOM_SIZE, Film, write_report
    except ImportError as error:
        raise InputError(f"{error.name} is not installed; pip install 'naod[demo]'") from error

    progress = Progress("showing the goal")
    experiment = Experiment(lockstep, seed)
    film = Film(lockstep)
    with Recorder(folder / "recording.mcap", "nao") as recorder:
        lockstep.listeners += [recorder.note, lambda tick: progress.tick(tick.commands.state.phase)]
        shown = experiment.demonstrate()
        experiment.carry_to_start()
        room_start = lockstep.robot.room_view(*ROOM_SIZE)
        lockstep.listeners.append(film.note)
        outcome = experiment.approach(shown)
    progress.label("writing figures")
    write_report(folder, lockstep, outcome, room_start)
    film.save(folder / "approach.gif")
    progress.done()
    return outcome
