"""The rooms of the benchmark: one in which the object is shown, others that are never shown."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import msgspec

from hal.scenario import Scenario, SceneSection, ThingSection
from naod.finding.walls import paint_wall
from naod.pose.objects import Cylinder, ObjectShape, Rectangle

Thing = Literal["can", "board"]
Walls = Literal["plain", "clutter", "picture"]

TABLE_TOP_M = 0.40
SPECK_M = 1e-4


class Room(msgspec.Struct, frozen=True):
    """`light` 1 is normal. `look_alikes`: things of the object's colour in other sizes and kinds.

    `walls`: "picture" are patches of many colours, made by the walk's seed as the clutter is.
    """

    walls: Walls = "clutter"
    light: float = 1.0
    look_alikes: bool = False


HOME = Room()
UNSEEN = {
    "dim": Room(light=0.75),
    "bright": Room(light=1.3),
    "other walls": Room(walls="picture", light=0.85),
    "look-alikes": Room(light=1.1, look_alikes=True),
}
"""Never shown; walked through with another seed than the room at home."""


def object_of(thing: Thing) -> ObjectShape:
    """Its sizes as the simulation has them."""
    return Cylinder() if thing == "can" else Rectangle()


def scenario_of(thing: Thing, room: Room, seed: int, folder: Path, absent: bool) -> Scenario:
    """The room with the object, or with a speck too small to see in its place.

    The wall's picture, if there is one, is written into `folder`.
    """
    background: str = room.walls
    if room.walls == "picture":
        background = "wall.png"
        paint_wall(folder / background, seed)
    return Scenario(
        object=_thing(thing, absent),
        distractor=_look_alikes(thing) if room.look_alikes else (),
        scene=SceneSection(background=background, light=room.light),
    )


def _thing(thing: Thing, absent: bool) -> ThingSection:
    speck = SPECK_M if absent else None
    if thing == "can":
        place = (1.2, 0.0, TABLE_TOP_M + SPECK_M) if absent else None
        return ThingSection(kind="cylinder", radius_m=speck, height_m=speck, position=place)
    return ThingSection(kind="rectangle", width_m=speck, height_m=speck)


def _look_alikes(thing: Thing) -> tuple[ThingSection, ...]:
    """A flat tin and a box lid beside the can, stripes beside the board."""
    if thing == "can":
        red = (200, 20, 30)
        return (
            ThingSection(
                kind="cylinder",
                radius_m=0.05,
                height_m=0.04,
                colour=red,
                position=(1.22, 0.20, TABLE_TOP_M + 0.02),
            ),
            ThingSection(
                kind="rectangle",
                width_m=0.16,
                height_m=0.05,
                colour=red,
                position=(1.20, -0.22, TABLE_TOP_M + 0.05),
            ),
        )
    yellow = (235, 200, 20)
    return (
        ThingSection(
            kind="rectangle",
            width_m=0.06,
            height_m=0.24,
            colour=yellow,
            position=(1.6, 0.35, 0.50),
        ),
        ThingSection(
            kind="cylinder",
            radius_m=0.04,
            height_m=0.10,
            colour=yellow,
            position=(1.45, -0.35, 0.45),
        ),
    )
