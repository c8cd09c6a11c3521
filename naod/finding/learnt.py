"""Colours that are learnt in a room made up, by every kind of model."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from naod.config import SegmentationConfig
from naod.finding.rooms import SIZE, Room, RoomSpec, Thing
from naod.perception.colour_model import ColourModel
from naod.perception.learning import KINDS, ModelKind, learn_model
from naod.perception.segmenter import Segmenter

THINGS: tuple[Thing, ...] = ("can", "ribbon", "board")


@dataclass(frozen=True, slots=True)
class Eye:
    """A model of a thing's colour and what segments with it."""

    kind: ModelKind
    model: ColourModel
    segmenter: Segmenter


class Learnt:
    """Eyes for each of the things, taught by one picture of a room; `folder` is for textures."""

    def __init__(self, folder: Path, seed: int = 0) -> None:
        self.settings = SegmentationConfig()
        self.eyes: dict[Thing, list[Eye]] = {
            thing: self._eyes(Room(RoomSpec(seed, thing), folder)) for thing in THINGS
        }

    def _eyes(self, room: Room) -> list[Eye]:
        picture, region = room.shown()
        models = [(kind, learn_model([picture], region, kind)) for kind in KINDS]
        return [Eye(kind, model, Segmenter(model, self.settings, SIZE)) for kind, model in models]
