"""Looking at the simulated robot: whether it can be built, and what it then shows."""

from __future__ import annotations

from hal.backends import OpenOptions
from hal.errors import HalError
from hal.health import Finding
from sim_backend.backend import open_robot

PICTURE_S = 3.0


def examine(options: OpenOptions) -> list[Finding]:
    """Open it by a clock that moves when waited for, take a picture, close it."""
    try:
        robot = open_robot(options)
    except HalError as error:
        return [Finding("simulation", "fail", str(error), "see sim.scenario")]
    try:
        frame, body = robot.camera.next(PICTURE_S), robot.body.latest()
        width, height = robot.camera.size
        text = f"a {robot.info.version}, {robot.scenario.object.kind} in its world"
        return [
            Finding("simulation", "ok", text),
            Finding("camera", "ok", f"{frame.camera}, YUYV {width}x{height}"),
            Finding("joints", "ok", f"warmest {body.temperature_max_c:.0f} C"),
            Finding("battery", "ok", f"{body.battery:.0%}"),
        ]
    except HalError as error:
        return [Finding("camera", "fail", str(error), "see camera in the scenario")]
    finally:
        robot.close()
