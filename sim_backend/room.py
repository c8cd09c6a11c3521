"""Floor, walls, clutter: the room around what matters, and the whole scene of a scenario."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hal.scenario import Scenario
from sim_backend.clutter import clutter
from sim_backend.furniture import has_table, panel, stand, table, thing_primitive
from sim_backend.poses import rot_x, rot_y, rot_z, transform
from sim_backend.scene import Primitive
from sim_backend.textures import Picture, floor_tiles, load_texture

WALL_HEIGHT_M = 2.6
MARGIN_M = 1.8
BEHIND_M = 1.0
"""Wall behind the object, farther than its table or its panel."""
TILE_M = 0.30
_WALL = (214, 212, 205)
_SIDE_WALL = (198, 204, 208)


@dataclass(frozen=True, slots=True)
class Room:
    """Its walls: from (x0, y0) to (x1, y1) in the world."""

    x0: float
    y0: float
    x1: float
    y1: float


def room_of(scenario: Scenario) -> Room:
    """A room with space around everything that is in it."""
    assert scenario.object.position is not None
    assert scenario.goal.demonstrate_at is not None
    places = [scenario.robot.start[:2], scenario.goal.demonstrate_at[:2]]
    yaw = math.radians(scenario.object.yaw_deg)
    x, y, _ = scenario.object.position
    places.append((x, y))
    places.extend(other.position[:2] for other in scenario.distractor if other.position)
    low, high = np.min(places, axis=0) - MARGIN_M, np.max(places, axis=0) + MARGIN_M
    back = (x - BEHIND_M * math.cos(yaw), y - BEHIND_M * math.sin(yaw))
    if math.cos(yaw) < -0.9:
        high[0] = max(back[0], max(place[0] for place in places) + 0.6)
    return Room(float(low[0]), float(low[1]), float(high[0]), float(high[1]))


def furnished(scenario: Scenario, folder: Path, seed: int) -> list[Primitive]:
    """Everything but the robot, for a resolved scenario. Raises ScenarioError."""
    thing = scenario.object
    room = room_of(scenario)
    parts = [thing_primitive(thing, "object", "object", folder)]
    if has_table(scenario):
        parts += table(scenario)
    if thing.kind == "rectangle":
        parts.append(panel(thing))
    for n, other in enumerate(scenario.distractor):
        parts.append(thing_primitive(other, "distractor", f"distractor[{n}]", folder))
        parts += stand(scenario, other)
    if scenario.scene.background == "clutter":
        parts += clutter(scenario, seed)
    return parts + shell(room, wall_picture(scenario, folder))


def wall_picture(scenario: Scenario, folder: Path) -> Picture | None:
    """The picture on the walls, if there is one. Raises ScenarioError."""
    background = scenario.scene.background
    if background in ("plain", "clutter"):
        return None
    return load_texture(folder / background, "scene.background")


def shell(room: Room, picture: Picture | None) -> list[Primitive]:
    """Floor, four walls and a ceiling; none casts a shadow."""
    a, b, h = (room.x1 - room.x0) / 2.0, (room.y1 - room.y0) / 2.0, WALL_HEIGHT_M / 2.0
    x, y = (room.x0 + room.x1) / 2.0, (room.y0 + room.y1) / 2.0
    repeat = (a / TILE_M / 2.0, b / TILE_M / 2.0)
    floor = Primitive(
        "rectangle", transform(np.eye(3), (x, y, 0.0)), (a, b, 0.0), (150, 150, 148),
        floor_tiles(), repeat, casts=False,
    )  # fmt: skip
    ceiling = Primitive(
        "rectangle", transform(rot_x(math.pi), (x, y, WALL_HEIGHT_M)), (a, b, 0.0),
        (236, 236, 232), casts=False,
    )  # fmt: skip
    walls = []
    for turn, half, place, colour in (
        (math.pi, b, (room.x1, y, h), _WALL),
        (0.0, b, (room.x0, y, h), _WALL),
        (-math.pi / 2.0, a, (x, room.y1, h), _SIDE_WALL),
        (math.pi / 2.0, a, (x, room.y0, h), _SIDE_WALL),
    ):
        R = rot_z(turn) @ rot_y(math.pi / 2.0) @ rot_z(math.pi / 2.0)
        walls.append(
            Primitive(
                "rectangle", transform(R, place), (half, h, 0.0), colour, picture, casts=False
            )
        )
    return [floor, ceiling, *walls]
