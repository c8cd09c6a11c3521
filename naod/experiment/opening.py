"""Opening a simulated robot for a scenario, with the equipment to go with it."""

from __future__ import annotations

from pathlib import Path

from hal.backends import OpenOptions, open_robot
from hal.errors import BackendError
from hal.scenario import Scenario
from hal.simulation import SimulatedRobot
from naod.config import DaemonConfig
from naod.experiment.lockstep import LockStep
from naod.files import read_toml
from naod.loop.equipment import Equipment
from naod.pose.objects import shape_of

SIMULATION = "sim"


def load_scenario(path: Path) -> Scenario:
    """Read SCENARIO.toml. Raises InputError that names the key."""
    return read_toml(path, Scenario)


def open_simulated(
    config: DaemonConfig, scenario: Scenario | None, folder: Path, seed: int, real_time: bool
) -> SimulatedRobot:
    """A simulated robot. Raises BackendError, ScenarioError."""
    options = OpenOptions(
        name=config.robot.name,
        version=config.robot.version,
        camera=config.camera.which,
        width=config.camera.width,
        height=config.camera.height,
        fps=config.camera.fps,
        section={
            "scenario": scenario,
            "scenario_folder": folder,
            "seed": seed,
            "real_time": real_time,
        },
    )
    robot = open_robot(SIMULATION, options)
    if not isinstance(robot, SimulatedRobot):
        raise BackendError(f"backend {SIMULATION!r} has no simulated world")
    return robot


def open_lockstep(
    config: DaemonConfig, scenario: Scenario, folder: Path, seed: int, compare_paper: bool
) -> LockStep:
    """A simulated robot with virtual time, and the loop to drive it."""
    robot = open_simulated(config, scenario, folder, seed, real_time=False)
    shape = shape_of(robot.scenario.object)
    equipment = Equipment.from_config(config, robot.info, shape, compare_paper)
    return LockStep(robot, equipment)
