"""The worlds of `naod demo`: a can on a table (5.2), a board in a cluttered room (5.3)."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from hal.scenario import (
    CameraSection,
    GoalSection,
    LimitsSection,
    RobotSection,
    Scenario,
    SceneSection,
    ThingSection,
)
from naod.geometry.transforms import wrap

DemoObject = Literal["can", "board"]

_CAN = ThingSection(
    kind="cylinder",
    radius_m=0.033,
    height_m=0.115,
    colour=(200, 20, 30),
    position=(1.2, 0.0, 0.4575),
    yaw_deg=180.0,
)
_BOARD = ThingSection(
    kind="rectangle",
    width_m=0.30,
    height_m=0.20,
    colour=(235, 200, 20),
    position=(1.6, 0.0, 0.50),
    yaw_deg=180.0,
)


def demo_scenario(name: DemoObject, seed: int) -> Scenario:
    """The world of a demo; where it starts and what is shown depend on the seed."""
    rng = np.random.default_rng([seed, 2014])
    thing = _CAN if name == "can" else _BOARD
    shown = _stance(thing, 0.42 if name == "can" else 0.65, rng.uniform(-8.0, 8.0), 0.0)
    start = _stance(
        thing, rng.uniform(1.0, 1.4), rng.uniform(-30.0, 30.0), rng.uniform(-25.0, 25.0)
    )
    return Scenario(
        robot=RobotSection(start=start),
        object=thing,
        goal=GoalSection(demonstrate_at=shown),
        scene=SceneSection(table=name == "can", background="plain" if name == "can" else "clutter"),
        camera=CameraSection(),
        limits=LimitsSection(time_s=180.0),
    )


def _stance(
    thing: ThingSection, distance_m: float, bearing_deg: float, turned_deg: float
) -> tuple[float, float, float]:
    """A pose before the object, `bearing` from its face's normal, turned away from facing it."""
    x, y, _ = thing.position or (0.0, 0.0, 0.0)
    azimuth = math.radians(thing.yaw_deg + bearing_deg)
    facing = wrap(azimuth + math.pi + math.radians(turned_deg))
    return (
        round(x + distance_m * math.cos(azimuth), 4),
        round(y + distance_m * math.sin(azimuth), 4),
        round(math.degrees(facing), 3),
    )
