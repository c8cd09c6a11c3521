"""What is known of the object beforehand: its shape and size (OBJECT.toml)."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import msgspec
from msgspec import Meta

from hal.scenario import ThingSection
from naod.files import read_toml

Positive = Annotated[float, Meta(gt=0.0, le=100.0)]


class Cylinder(
    msgspec.Struct,
    frozen=True,
    kw_only=True,
    forbid_unknown_fields=True,
    tag_field="kind",
    tag="cylinder",
):
    """A can: y along its axis; it has no front, so z is horizontal towards the camera."""

    radius_m: Positive = 0.033
    height_m: Positive = 0.115


class Rectangle(
    msgspec.Struct,
    frozen=True,
    kw_only=True,
    forbid_unknown_fields=True,
    tag_field="kind",
    tag="rectangle",
):
    """A flat board: x to the right, y up, z out of its face."""

    width_m: Positive = 0.30
    height_m: Positive = 0.20


ObjectShape = Cylinder | Rectangle


def load_object(path: Path) -> ObjectShape:
    """Read OBJECT.toml. Raises InputError that names the file and the key."""
    return read_toml(path, ObjectShape)  # type: ignore[arg-type]


def shape_of(thing: ThingSection) -> ObjectShape:
    """The object's shape and size as the robot is told them."""
    given = {"radius_m", "height_m"} if thing.kind == "cylinder" else {"width_m", "height_m"}
    fields = {k: v for k in sorted(given) if (v := getattr(thing, k)) is not None}
    if thing.kind == "cylinder":
        return msgspec.convert(fields, Cylinder)
    return msgspec.convert(fields, Rectangle)
