"""All checks in turn. None moves the robot or leaves anything changed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from hal.backends import examine
from hal.errors import HalError
from hal.health import Finding
from naod.config import DaemonConfig
from naod.daemon.opening import options_of
from naod.doctor.bus import examine_bus
from naod.doctor.daemon import examine_daemon
from naod.doctor.keeping import examine_configuration, examine_state
from naod.doctor.machine import examine_machine
from naod.errors import InputError


def examination(config: DaemonConfig, source: str, beside: Path) -> Iterator[Finding]:
    """The findings as they come; paths in the configuration are `beside` its file."""
    yield from examine_configuration(config, source)
    yield from examine_state(config)
    # LoLA's client has a cycle of 12 ms to answer in; the others have none
    yield from examine_machine(config.robot.backend == "lola")
    bus = examine_bus(config.bus, config.robot.name)
    yield from bus.findings
    if bus.daemon is not None:
        yield from examine_daemon(bus.daemon, config.robot.name)
    else:
        yield from _robot(config, beside)


def _robot(config: DaemonConfig, beside: Path) -> list[Finding]:
    backend = config.robot.backend
    try:
        return examine(backend, options_of(config, beside, real_time=False))
    except (HalError, InputError) as error:
        return [Finding("backend", "fail", str(error), f"see [{backend}] in the configuration")]
