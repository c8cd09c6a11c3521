"""The configuration's own sense, and the state folder; nothing is made or written."""

from __future__ import annotations

import os
from pathlib import Path

from hal.health import Finding
from naod.approach.goal import load_goals
from naod.config import DaemonConfig, state_folder
from naod.errors import InputError
from naod.perception.colour_model import load_model
from naod.walk_server.latch import EstopLatch

RIGHT_OF_A_FOLDER = os.W_OK | os.X_OK


def examine_configuration(config: DaemonConfig, source: str) -> list[Finding]:
    """What can be read and is still not wise."""
    camera, robot = config.camera, config.robot
    text = f"{source}: backend {robot.backend}, {robot.version}, {camera.which} camera"
    found = [Finding("configuration", "ok", f"{text} {camera.width}x{camera.height}")]
    if robot.backend != "sim" and camera.fx is None and not any(camera.correction_deg):
        text = "this head's camera is taken for the nominal one; it may be off by degrees"
        found.append(Finding("calibration", "warn", text, "run `naod calibrate`"))
    if robot.backend == "lola" and robot.version != "v6":
        text = f"a {robot.version} has no LoLA, only a v6"
        found.append(Finding("configuration", "warn", text, 'set robot.version = "v6"'))
    return found


def examine_state(config: DaemonConfig) -> list[Finding]:
    """Whether what outlives the daemon can be kept, and what has been."""
    folder = state_folder(config)
    there = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    if not there.is_dir():
        return [Finding("state folder", "fail", f"{there}: is not a folder", "set state_folder")]
    if not os.access(there, RIGHT_OF_A_FOLDER):
        text = f"{folder}: cannot be written"
        return [Finding("state folder", "fail", text, "set robot.state_folder to one that can")]
    if there != folder:
        return [Finding("state folder", "ok", f"{folder}: not there yet, can be made")]
    return [_kept(folder), *_latched(folder)]


def _kept(folder: Path) -> Finding:
    try:
        goals = len(load_goals(folder))
        model = folder / "model.toml"
        colour = "a colour" if model.exists() and load_model(model) else "no colour"
    except InputError as error:
        return Finding("state folder", "fail", str(error), "move that file away")
    return Finding("state folder", "ok", f"{folder}: {colour}, {goals} goals")


def _latched(folder: Path) -> list[Finding]:
    if not EstopLatch(folder).is_set():
        return []
    return [Finding("estop", "warn", "latched: nothing will move", "`naod ctl release`")]
