"""Robots in lock-step or real time, closed after the test."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from sim_world import CALM, Opened

from hal.backends import OpenOptions
from hal.scenario import Scenario
from sim_backend.backend import SimRobot, open_robot


@pytest.fixture
def opened() -> Iterator[Opened]:
    """Open a robot with small pictures: `opened(scenario, seed=..., size=..., ...)`."""
    robots: list[SimRobot] = []

    def _open(
        scenario: Scenario | None = CALM,
        *,
        seed: int = 0,
        real_time: bool = False,
        size: tuple[int, int] = (160, 120),
        fps: int = 15,
    ) -> SimRobot:
        section = {"scenario": scenario, "seed": seed, "real_time": real_time}
        robot = open_robot(OpenOptions(width=size[0], height=size[1], fps=fps, section=section))
        robots.append(robot)
        return robot

    yield _open
    for robot in robots:
        robot.close()
