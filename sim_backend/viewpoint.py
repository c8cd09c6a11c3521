"""Where the room is looked at from: the robot, its table and the way between in one picture."""

from __future__ import annotations

import math

import numpy as np

from hal.nao.cameras import PinholeFigures
from hal.scenario import Scenario
from sim_backend.poses import Matrix, transform
from sim_backend.room import room_of

FIELD_RAD = math.radians(46.0)
DOWN_RAD = math.radians(24.0)
ASIDE_RAD = math.radians(62.0)
BOARD_ASIDE_RAD = math.radians(38.0)
HEIGHT_OF_INTEREST_M = 0.33
INSIDE_M = 0.15


def looking(eye: tuple[float, float, float], at: tuple[float, float, float]) -> Matrix:
    """T_world_camera of a level camera at a place looking at another, (4, 4)."""
    forward = np.array(at) - np.array(eye)
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    return transform(np.stack([right, np.cross(forward, right), forward], axis=1), eye)


def room_camera(scenario: Scenario) -> Matrix:
    """T_world_camera of the view of the room: robot, object and the way between."""
    assert scenario.object.position is not None
    start, thing = np.array(scenario.robot.start[:2]), np.array(scenario.object.position[:2])
    way = thing - start
    length = float(np.linalg.norm(way))
    heading = math.atan2(way[1], way[0]) if length > 1e-6 else 0.0
    middle = start + 0.55 * way
    back = _direction(scenario, heading)
    distance = 1.05 * (0.55 * length + 0.55) / math.tan(FIELD_RAD / 2.0)
    room = room_of(scenario)
    x = middle[0] + distance * math.cos(DOWN_RAD) * math.cos(back)
    y = middle[1] + distance * math.cos(DOWN_RAD) * math.sin(back)
    x = min(max(x, room.x0 + INSIDE_M), room.x1 - INSIDE_M)
    y = min(max(y, room.y0 + INSIDE_M), room.y1 - INSIDE_M)
    z = HEIGHT_OF_INTEREST_M + distance * math.sin(DOWN_RAD)
    return looking((x, y, z), (float(middle[0]), float(middle[1]), HEIGHT_OF_INTEREST_M))


def _direction(scenario: Scenario, heading: float) -> float:
    """Azimuth towards the eye: aside of the way, and for a board where its face is seen."""
    if scenario.object.kind == "cylinder":
        return heading + math.pi + ASIDE_RAD
    face = math.radians(scenario.object.yaw_deg)
    from_side = math.remainder(heading + math.pi - face, 2.0 * math.pi)
    # on the side away from the start, so that the robot does not stand before the board
    return face - math.copysign(BOARD_ASIDE_RAD, from_side)


def room_lens(width: int, height: int) -> PinholeFigures:
    """Its lens, at any size."""
    focal = 0.5 * max(width, height * 4.0 / 3.0) / math.tan(FIELD_RAD / 2.0)
    return PinholeFigures(width, height, focal, focal, 0.5 * (width - 1), 0.5 * (height - 1))
