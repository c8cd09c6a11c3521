"""The object, its table or panel, the distractors and what carries them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from hal.nao.joints import Vector3
from hal.scenario import Scenario, ThingSection
from sim_backend.poses import Matrix, moved, rot_z, transform
from sim_backend.scene import Primitive
from sim_backend.textures import load_texture, wood

TABLE_FRONT_M, TABLE_DEPTH_M, TABLE_WIDTH_M = 0.12, 0.50, 0.90
TABLE_THICK_M, TABLE_LEG_M = 0.025, 0.02
PANEL_WIDTH_M, PANEL_TOP_M, PANEL_THICK_M, PANEL_GAP_M = 2.4, 1.3, 0.04, 0.004
ON_FLOOR_M = 0.02

_LEG = (150, 152, 156)
_PANEL = (206, 205, 200)
_STAND = (224, 224, 222)


def upright(thing: ThingSection) -> Matrix:
    """T_world of a frame at its centre: x the way it faces, z up."""
    assert thing.position is not None
    return transform(rot_z(math.radians(thing.yaw_deg)), thing.position)


def object_frame(thing: ThingSection) -> Matrix:
    """T_world_object: x to the right as seen from before it, y up, z out of its face."""
    return upright(thing) @ transform(
        np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]), (0.0, 0.0, 0.0)
    )


def height_of(thing: ThingSection) -> float:
    """Height in m of a resolved thing."""
    assert thing.height_m is not None
    return thing.height_m


def bottom_of(thing: ThingSection) -> float:
    """Height of its lower edge above the floor."""
    assert thing.position is not None
    return thing.position[2] - height_of(thing) / 2.0


def thing_primitive(thing: ThingSection, role: str, key: str, folder: Path) -> Primitive:
    """The thing itself. Raises ScenarioError if its texture cannot be read."""
    assert thing.colour is not None
    texture = None
    if thing.texture is not None:
        texture = load_texture(folder / thing.texture, f"{key}.texture")
    half = height_of(thing) / 2.0
    if thing.kind == "cylinder":
        assert thing.radius_m is not None
        size = (thing.radius_m, half, 0.0)
        return Primitive("cylinder", upright(thing), size, thing.colour, texture, role=role)
    assert thing.width_m is not None
    size = (thing.width_m / 2.0, half, 0.0)
    return Primitive("rectangle", object_frame(thing), size, thing.colour, texture, role=role)


def has_table(scenario: Scenario) -> bool:
    """Whether the object stands on a table."""
    thing = scenario.object
    return scenario.scene.table and thing.kind == "cylinder" and bottom_of(thing) > ON_FLOOR_M


def table_frame(scenario: Scenario) -> Matrix:
    """T_world of the middle of the table's top face; x towards the side the object faces."""
    behind = TABLE_DEPTH_M / 2.0 - TABLE_FRONT_M
    return upright(scenario.object) @ moved(-behind, 0.0, -height_of(scenario.object) / 2.0)


def table(scenario: Scenario) -> list[Primitive]:
    """Top and four legs."""
    T_top = table_frame(scenario)
    height = float(T_top[2, 3])
    a, b, c = TABLE_DEPTH_M / 2.0, TABLE_WIDTH_M / 2.0, TABLE_THICK_M / 2.0
    # its own x along the width, so that the wood's grain runs along the table
    T_board = T_top @ transform(rot_z(math.pi / 2.0), (0.0, 0.0, -c))
    parts = [Primitive("box", T_board, (b, a, c), (176, 138, 96), wood())]
    half = (height - TABLE_THICK_M) / 2.0
    for x in (-a + 0.04, a - 0.04):
        for y in (-b + 0.04, b - 0.04):
            T_leg = T_top @ moved(x, y, -TABLE_THICK_M - half)
            parts.append(Primitive("box", T_leg, (TABLE_LEG_M, TABLE_LEG_M, half), _LEG))
    return parts


def panel(thing: ThingSection) -> Primitive:
    """The wall a rectangle hangs on."""
    assert thing.position is not None
    top = max(PANEL_TOP_M, thing.position[2] + height_of(thing))
    half = (PANEL_THICK_M / 2.0, PANEL_WIDTH_M / 2.0, top / 2.0)
    T_wall = upright(thing) @ moved(-PANEL_GAP_M - half[0], 0.0, top / 2.0 - thing.position[2])
    return Primitive("box", T_wall, half, _PANEL)


def stand(scenario: Scenario, thing: ThingSection) -> list[Primitive]:
    """What keeps a distractor off the floor, if the table or the panel does not."""
    assert thing.position is not None
    low = bottom_of(thing)
    if low < ON_FLOOR_M:
        return []
    if thing.kind == "cylinder":
        if has_table(scenario) and _is_on(table_frame(scenario), thing, low):
            return []
        assert thing.radius_m is not None
        half: Vector3 = (thing.radius_m + 0.02, thing.radius_m + 0.02, low / 2.0)
        return [
            Primitive(
                "box", upright(thing) @ moved(0, 0, low / 2.0 - thing.position[2]), half, _STAND
            )
        ]
    half_post = (0.012, 0.03, thing.position[2] / 2.0)
    post = upright(thing) @ moved(-0.016, 0.0, -thing.position[2] / 2.0)
    return [Primitive("box", post, half_post, _STAND)]


def _is_on(T_top: Matrix, thing: ThingSection, low: float) -> bool:
    assert thing.position is not None
    place = T_top[:3, :3].T @ (np.array(thing.position) - T_top[:3, 3])
    within = abs(place[0]) <= TABLE_DEPTH_M / 2.0 and abs(place[1]) <= TABLE_WIDTH_M / 2.0
    return bool(within) and abs(low - float(T_top[2, 3])) < ON_FLOOR_M
