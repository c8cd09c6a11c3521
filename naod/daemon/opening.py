"""Opening the robot that the configuration names."""

from __future__ import annotations

from pathlib import Path

from hal.backends import OpenOptions, open_robot
from hal.protocols import Robot
from hal.scenario import Scenario
from hal.simulation import SimulatedRobot
from naod.config import DaemonConfig
from naod.errors import InputError
from naod.files import read_toml
from naod.pose.objects import Cylinder, ObjectShape, shape_of


def open_configured(config: DaemonConfig, beside: Path, real_time: bool = True) -> Robot:
    """Open it; paths in the configuration are `beside` the file. Raises InputError, HalError.

    `real_time`: a simulated robot otherwise goes by a clock that moves when somebody waits.
    """
    return open_robot(config.robot.backend, options_of(config, beside, real_time))


def options_of(config: DaemonConfig, beside: Path, real_time: bool = True) -> OpenOptions:
    """What the configured backend is told. Raises InputError."""
    if config.camera.device and config.robot.backend != "lola":
        raise InputError(
            f"camera.device: backend {config.robot.backend!r} has a camera of its own; "
            'a device is for "lola"'
        )
    section: dict[str, object] = {}
    if config.robot.backend == "sim":
        section = _simulation(config, beside, real_time)
    elif config.robot.backend == "naoqi":
        section = {
            "url": config.naoqi.url,
            "user": config.naoqi.user,
            "password_file": _file(config.naoqi.password_file, beside),
            "wake_up": config.naoqi.wake_up,
            "controls": config.camera.controls,
        }
    else:
        section = {
            "socket": config.lola.socket,
            "stand_up": config.lola.stand_up,
            "sit_after_s": config.lola.sit_after_s,
            "when_fallen": config.lola.when_fallen,
            "device": _device(config.camera.device, beside),
            "controls": config.camera.controls,
        }
    return OpenOptions(
        name=config.robot.name,
        version=config.robot.version,
        camera=config.camera.which,
        width=config.camera.width,
        height=config.camera.height,
        fps=config.camera.fps,
        section=section,
    )


def shape_for(config: DaemonConfig, robot: Robot) -> ObjectShape:
    """The object as configured; in simulation, else, the one that stands there."""
    if config.object is not None:
        return config.object
    if isinstance(robot, SimulatedRobot):
        return shape_of(robot.scenario.object)
    return Cylinder()


def _file(path: str, beside: Path) -> str:
    return str(beside / Path(path).expanduser()) if path else ""


def _device(device: str, beside: Path) -> str:
    """A path `beside` the file; an address is one already."""
    is_path = device and not device.startswith(("tcp:", "unix:"))
    return str(beside / device) if is_path else device


def _simulation(config: DaemonConfig, beside: Path, real_time: bool) -> dict[str, object]:
    path = beside / config.sim.scenario if config.sim.scenario else None
    return {
        "scenario": read_toml(path, Scenario) if path is not None else None,
        "scenario_folder": path.parent if path is not None else beside,
        "seed": config.sim.seed,
        "real_time": real_time,
    }
