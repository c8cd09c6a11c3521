"""Messages on the bus, under `nao/<robot>/`, as JSON. Units are in the names or stated here.

Numbers that are not finite do not pass: JSON has none, and `decode` refuses them.
"""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
from msgspec import Meta

Name = Annotated[str, Meta(min_length=1, max_length=64)]
Sequence = Annotated[int, Meta(ge=0, le=2**63 - 1)]
TtlMs = Annotated[int, Meta(gt=0, le=1000)]

MOVE_KINDS = ("velocity", "step", "stop")


class Message(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Base of all messages: immutable, fields by name, nothing unknown."""


class WalkCommand(Message, frozen=True):
    """`walk/command`. velocity: m/s and rad/s, ends after `ttl_ms` unless renewed.

    step: m and rad, from where the base is now. stop: x, y and yaw do not matter.
    """

    source: Name
    seq: Sequence
    kind: Literal["velocity", "step", "stop"]
    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0
    ttl_ms: TtlMs = 300


class WalkState(Message, frozen=True):
    """`walk/state`. velocity in m/s and rad/s; odometry in m and rad; `refused` says why."""

    seq: int
    stamp_ns: int
    moving: bool
    fallen: bool
    held_by: str | None
    velocity: tuple[float, float, float]
    last_source: str | None
    refused: str | None
    odometry: tuple[float, float, float]


class HeadCommand(Message, frozen=True):
    """`head/command`: angles in rad."""

    source: Name
    seq: Sequence
    yaw: float
    pitch: float
    ttl_ms: TtlMs = 300


class EgoMessage(Message, frozen=True):
    """The ego-cylinder, equation 6: distance, azimuth, height, and azimuth of the object's z."""

    rho_m: float
    theta_rad: float
    z_m: float
    phi_rad: float


class TargetMessage(Message, frozen=True):
    """What is known of the object; `sigma_m` is the standard deviation of its place."""

    found: bool
    age_s: float | None
    ego: EgoMessage | None
    sigma_m: float | None


class ErrorMessage(Message, frozen=True):
    """From the base to the goal, in the base frame: m, m, rad."""

    x_m: float
    y_m: float
    yaw_rad: float


class StateMessage(Message, frozen=True):
    """`state`: what the tracker does and knows."""

    seq: int
    stamp_ns: int
    mode: Literal["idle", "track", "approach"]
    phase: str
    goal: str | None
    target: TargetMessage
    error: ErrorMessage | None
    faults: tuple[str, ...]


class EventMessage(Message, frozen=True):
    """`event`: something happened, once."""

    stamp_ns: int
    kind: str
    message: str


class TruthMessage(Message, frozen=True):
    """`sim/truth`: base x, y (m), yaw (rad); object x, y, z (m), yaw (rad)."""

    stamp_ns: int
    base: tuple[float, float, float]
    object: tuple[float, float, float, float]


class DiagnosticsMessage(Message, frozen=True):
    """`diagnostics`, 1 Hz: the loop's period and latency in ms, counts since start-up."""

    stamp_ns: int
    period_ms: float
    period_max_ms: float
    latency_ms: float
    overruns: int
    frames: int
    refused: int
    memory_mb: float
    temperature_max_c: float
    battery: float
