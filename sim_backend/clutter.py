"""A many-coloured room: boxes, cylinders and posters, placed by the seed.

Nothing stands between the object and where a robot would look at it from, and no colour equals the
object's; some come near it.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hal.scenario import Scenario
from sim_backend.furniture import (
    PANEL_TOP_M,
    PANEL_WIDTH_M,
    TABLE_DEPTH_M,
    TABLE_FRONT_M,
    height_of,
    upright,
)
from sim_backend.poses import Matrix, moved, rot_z, transform
from sim_backend.scene import Primitive
from sim_backend.streams import Purpose, stream

POSTERS, BLOCKS, DRUMS = 16, 12, 8
NEAR_SHARE = 0.2
LEAST_COLOUR_GAP = 48.0
"""Distance in RGB levels every piece keeps from the object's colour."""
CLEAR_M = 0.75
"""Half width of what is kept free before the object."""
WAY_M = 0.45
"""Free on both sides of the straight ways between start, shown pose and object."""


def clutter(scenario: Scenario, seed: int) -> list[Primitive]:
    """Pieces behind and beside the object, on the floor and on the wall behind it."""
    rng = stream(seed, Purpose.CLUTTER)
    return _posters(scenario, rng) + _pieces(scenario, rng)


def _colour(scenario: Scenario, rng: np.random.Generator) -> tuple[int, int, int]:
    assert scenario.object.colour is not None
    own = np.array(scenario.object.colour, dtype=np.float64)
    while True:
        if rng.random() < NEAR_SHARE:
            way = rng.normal(0.0, 1.0, 3)
            levels = own + way / np.linalg.norm(way) * rng.uniform(60.0, 110.0)
        else:
            levels = rng.uniform(20.0, 240.0, 3)
        levels = np.clip(np.rint(levels), 0, 255)
        if np.linalg.norm(levels - own) >= LEAST_COLOUR_GAP:
            return (int(levels[0]), int(levels[1]), int(levels[2]))


def _behind(scenario: Scenario) -> float:
    """Distance from the object's middle to where the room behind it is free."""
    if scenario.object.kind == "rectangle":
        return 0.0
    return TABLE_DEPTH_M - TABLE_FRONT_M + 0.05


def _posters(scenario: Scenario, rng: np.random.Generator) -> list[Primitive]:
    """Coloured sheets on the panel around a rectangle, or on a screen behind the table."""
    thing = scenario.object
    assert thing.position is not None
    flat = thing.kind == "rectangle"
    back = -0.002 if flat else -_behind(scenario) - 0.30
    T_wall = upright(thing) @ moved(back, 0.0, -thing.position[2])
    span = PANEL_WIDTH_M / 2.0
    parts = [] if flat else [_screen(T_wall, span)]
    for n in range(POSTERS):
        half = (rng.uniform(0.05, 0.16), rng.uniform(0.05, 0.16))
        y = rng.uniform(-span + half[0], span - half[0])
        z = rng.uniform(half[1] + 0.02, PANEL_TOP_M - half[1])
        if flat and _overlaps(scenario, y, z, half):
            continue
        # sheets lie on each other: each a little nearer, so that none fights with another
        T = T_wall @ transform(_FACING, (0.0001 * n - (0.0018 if flat else 0.0), y, z))
        parts.append(Primitive("rectangle", T, (*half, 0.0), _colour(scenario, rng), casts=False))
    return parts


_FACING: Matrix = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


def _screen(T_wall: Matrix, span: float) -> Primitive:
    half = (0.02, span, PANEL_TOP_M / 2.0)
    return Primitive("box", T_wall @ moved(-0.021, 0.0, PANEL_TOP_M / 2.0), half, (206, 205, 200))


def _overlaps(scenario: Scenario, y: float, z: float, half: tuple[float, float]) -> bool:
    thing = scenario.object
    assert thing.position is not None
    assert thing.width_m is not None
    across = abs(y) < half[0] + thing.width_m / 2.0 + 0.01
    return across and abs(z - thing.position[2]) < half[1] + height_of(thing) / 2.0 + 0.01


def _pieces(scenario: Scenario, rng: np.random.Generator) -> list[Primitive]:
    """Boxes and drums on the floor, beside the way to the object and behind it."""
    thing = scenario.object
    assert thing.position is not None
    T_floor = upright(thing) @ moved(0.0, 0.0, -thing.position[2])
    parts = []
    for n in range(BLOCKS + DRUMS):
        side = 1.0 if rng.random() < 0.5 else -1.0
        x = rng.uniform(-_behind(scenario) - 0.15, 0.30)
        y = side * rng.uniform(CLEAR_M, 1.45)
        high = rng.uniform(0.08, 0.42)
        colour, turn = _colour(scenario, rng), rng.uniform(0.0, math.pi)
        T = T_floor @ transform(rot_z(turn), (x, y, high))
        if n < BLOCKS:
            size = (rng.uniform(0.05, 0.14), rng.uniform(0.05, 0.14), high)
            piece = Primitive("box", T, size, colour)
        else:
            piece = Primitive("cylinder", T, (rng.uniform(0.04, 0.11), high, 0.0), colour)
        if not _stands_in_the_way(scenario, T[:2, 3]):
            parts.append(piece)
    return parts


def _stands_in_the_way(scenario: Scenario, place: NDArray[np.float64]) -> bool:
    assert scenario.object.position is not None
    assert scenario.goal.demonstrate_at is not None
    ends = [scenario.robot.start[:2], scenario.goal.demonstrate_at[:2]]
    ends.append(scenario.object.position[:2])
    return any(
        _distance_to_way(place, np.array(a), np.array(b)) < WAY_M
        for a, b in zip(ends, ends[1:] + ends[:1], strict=True)
    )


def _distance_to_way(
    place: NDArray[np.float64], a: NDArray[np.float64], b: NDArray[np.float64]
) -> float:
    """Distance of a place on the floor from the straight way between two others."""
    way = b - a
    length = float(way @ way)
    share = min(max(float((place - a) @ way) / length, 0.0), 1.0) if length > 0.0 else 0.0
    return float(np.linalg.norm(place - a - share * way))
