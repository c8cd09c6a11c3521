"""Messages on the bus, under `nao/<robot>/`, as JSON. Units are in the names or stated here.

Numbers that are not finite do not pass: JSON has none, and `naod.bus.wire` refuses them.
"""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
from msgspec import Meta

# no control characters: names are printed on terminals and written to logs
Name = Annotated[str, Meta(min_length=1, max_length=64, pattern=r"^[^\x00-\x1f\x7f-\x9f]+$")]
Sequence = Annotated[int, Meta(ge=0, le=2**63 - 1)]
TtlMs = Annotated[int, Meta(gt=0, le=1000)]

TRACKER = "tracker"
"""The `source` of the daemon's own commands; every other source is an operator."""


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
    """`diagnostics`, 1 Hz: over the last second, and counts since start-up.

    `period_ms` is the mean, `jitter_ms` the standard deviation; `latency_ms` is the mean from the
    middle of an exposure to the commands that came of it. `refused` counts messages. `blur_px`: how
    far the object moved through the last picture during its exposure; None when it is not in view.
    """

    stamp_ns: int
    period_ms: float
    period_max_ms: float
    jitter_ms: float
    latency_ms: float
    overruns: int
    frames: int
    refused: int
    memory_mb: float
    temperature_max_c: float
    battery: float
    blur_px: float | None = None


class NoArguments(Message, frozen=True):
    """`rpc/status`, `stop`, `estop`, `release`, `goals`, `watch`: nothing to say."""


class GoalCall(Message, frozen=True):
    """`rpc/start` and `rpc/teach`: a goal by its name."""

    goal: Name


class LabelCall(Message, frozen=True):
    """`rpc/label`: a region of the camera's picture, in pixels."""

    x: Annotated[int, Meta(ge=0, le=4096)]
    y: Annotated[int, Meta(ge=0, le=4096)]
    width: Annotated[int, Meta(gt=0, le=4096)]
    height: Annotated[int, Meta(gt=0, le=4096)]


class RobotMessage(Message, frozen=True):
    """Which robot answers."""

    name: str
    version: str
    backend: str
    simulated: bool


class StatusReply(Message, frozen=True, kw_only=True):
    """Answer of `rpc/status`; `estopped` is latched until `release`."""

    ok: Literal[True] = True
    version: str
    robot: RobotMessage
    estopped: bool
    labelled: bool
    goals: tuple[str, ...]
    state: StateMessage | None
    walk: WalkState | None
    diagnostics: DiagnosticsMessage | None


class PictureReply(Message, frozen=True, kw_only=True):
    """Answer to `rpc/picture`: the newest picture, `jpeg` in base64; size in pixels."""

    ok: Literal[True] = True
    stamp_ns: int
    width: int
    height: int
    jpeg: bytes


class FailureDetail(Message, frozen=True):
    """`code` is for programs, `message` for people."""

    code: str
    message: str


class FailureReply(Message, frozen=True, kw_only=True):
    """Answer of any `rpc/<verb>` that was not done."""

    ok: Literal[False] = False
    error: FailureDetail
