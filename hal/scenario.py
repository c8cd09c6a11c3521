"""SCENARIO.toml: the world a simulation backend builds. Every key has a default."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from hal.types import NaoVersion

Positive = Annotated[float, Meta(gt=0.0)]
NotNegative = Annotated[float, Meta(ge=0.0)]
Fraction = Annotated[float, Meta(ge=0.0, le=1.0)]
Level = Annotated[int, Meta(ge=0, le=255)]
Colour = tuple[Level, Level, Level]
Kind = Literal["cylinder", "rectangle"]


class _Section(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    pass


class RobotSection(_Section, frozen=True):
    """`start`: x in m, y in m, yaw in degrees."""

    version: NaoVersion = "v6"
    start: tuple[float, float, float] = (0.0, 0.0, 0.0)


class ThingSection(_Section, frozen=True):
    """A cylinder or a rectangle in the world; `position` is that of its centre, in m.

    It faces the way its yaw points: 0 is along the world's x.
    """

    kind: Kind = "cylinder"
    radius_m: Positive | None = None
    width_m: Positive | None = None
    height_m: Positive | None = None
    colour: Colour | None = None
    texture: str | None = None
    position: tuple[float, float, float] | None = None
    yaw_deg: float = 180.0


class GoalSection(_Section, frozen=True):
    """`demonstrate_at`: x in m, y in m, yaw in degrees; None for a place before the object."""

    demonstrate_at: tuple[float, float, float] | None = None


class SceneSection(_Section, frozen=True):
    """`light` 1 is normal; `light_drift` is its relative change per minute."""

    table: bool = True
    background: str = "plain"
    light: Positive = 1.0
    light_drift: float = 0.0


class CameraSection(_Section, frozen=True):
    """`noise_std` in 8-bit levels, `drop_rate` as a fraction of frames.

    `mount_error_deg`: roll, pitch and yaw, about the camera's own body axes (x forward, y left,
    z up), by which it sits askew in the head; the robot does not know of it.
    """

    noise_std: NotNegative = 2.0
    blur: bool = True
    drop_rate: Fraction = 0.0
    latency_s: NotNegative = 0.05
    mount_error_deg: tuple[float, float, float] = (0.0, 0.0, 0.0)


class WalkSection(_Section, frozen=True):
    """`slip_std` relative, per move; `yaw_drift` in rad per metre; `push` in N s."""

    model: Literal["kinematic", "dynamic"] = "kinematic"
    slip_std: NotNegative = 0.05
    yaw_drift: float = 0.02
    push: NotNegative = 0.0


class LimitsSection(_Section, frozen=True):
    """`time_s`: simulated time after which an approach counts as failed."""

    time_s: Positive = 120.0


class Scenario(_Section, frozen=True):
    """A whole SCENARIO.toml."""

    robot: RobotSection = RobotSection()
    object: ThingSection = ThingSection()
    goal: GoalSection = GoalSection()
    distractor: tuple[ThingSection, ...] = ()
    scene: SceneSection = SceneSection()
    camera: CameraSection = CameraSection()
    walk: WalkSection = WalkSection()
    limits: LimitsSection = LimitsSection()
