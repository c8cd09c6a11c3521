"""The daemon's configuration file. Every key has a default; an unknown one is an error."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from hal.nao.cameras import SIZES
from hal.types import CameraName, NaoVersion
from naod.files import read_toml
from naod.pose.objects import ObjectShape

Positive = Annotated[float, Meta(gt=0.0)]
NotNegative = Annotated[float, Meta(ge=0.0)]
Fraction = Annotated[float, Meta(ge=0.0, le=1.0)]
Count = Annotated[int, Meta(gt=0)]
Setting = Annotated[int, Meta(ge=0, le=1 << 20)]
ROBOT_NAME = r"^[A-Za-z0-9_-]{1,32}$"
RobotName = Annotated[str, Meta(pattern=ROBOT_NAME)]
Width = Literal[80, 160, 320]


class _Section(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    pass


class RobotConfig(_Section, frozen=True):
    """Which robot; `state_folder` keeps goals, the colour model and the latched estop."""

    name: RobotName = "nao"
    version: NaoVersion = "v6"
    backend: Literal["sim", "naoqi", "lola"] = "sim"
    state_folder: str = ""


class SimConfig(_Section, frozen=True):
    """`scenario`: a SCENARIO.toml; empty for the can on the table."""

    scenario: str = ""
    seed: Annotated[int, Meta(ge=0)] = 0


class NaoqiConfig(_Section, frozen=True):
    """Where NAOqi listens, and who we are there.

    `password_file`: for NAOqi 2.9; without one the environment's NAOQI_PASSWORD is taken, if set.
    `wake_up`: a walk asked for while the robot rests makes it stand up, and is itself refused.
    """

    url: str = "tcp://127.0.0.1:9559"
    user: str = "nao"
    password_file: str = ""
    wake_up: bool = True


class LolaConfig(_Section, frozen=True):
    """Where LoLA listens, and when the robot stands up and sits down by itself.

    `stand_up`: "button" holds the pose it is found in until the chest button is pressed.
    `when_fallen`: what becomes of its joints.
    """

    socket: str = "/tmp/robocup"
    stand_up: Literal["button", "start"] = "button"
    sit_after_s: Positive = 10.0
    when_fallen: Literal["limp", "stiff"] = "limp"


class CameraConfig(_Section, frozen=True):
    """Camera, its intrinsics in pixels if calibrated, and this head's correction.

    `correction_deg`: roll, pitch and yaw that turn the nominal camera into the real one.
    `exposure`, `gain`, `white_balance`, `focus`: held, in the driver's units; without them, what
    the camera's automatic has found at the start.
    """

    which: CameraName = "top"
    device: str = ""
    width: Literal[160, 320, 640, 1280] = 640
    height: Literal[120, 240, 480, 960] = 480
    fps: Annotated[int, Meta(ge=1, le=30)] = 15
    fx: Positive | None = None
    fy: Positive | None = None
    cx: float | None = None
    cy: float | None = None
    distortion: tuple[float, float, float, float, float] | None = None
    correction_deg: tuple[float, float, float] = (0.0, 0.0, 0.0)
    exposure: Setting | None = None
    gain: Setting | None = None
    white_balance: Setting | None = None
    focus: Setting | None = None

    @property
    def controls(self) -> dict[str, int]:
        """The values that are given, by name."""
        names = ("exposure", "gain", "white_balance", "focus")
        given = {name: getattr(self, name) for name in names}
        return {name: value for name, value in given.items() if value is not None}

    def __post_init__(self) -> None:
        if (self.width, self.height) not in SIZES:
            known = ", ".join(f"{w}x{h}" for w, h in SIZES)
            raise ValueError(f"width x height {self.width}x{self.height}: known: {known}")


class BusConfig(_Section, frozen=True):
    """zenoh endpoints; loopback unless told otherwise, no multicast scouting unless told."""

    listen: tuple[str, ...] = ("tcp/127.0.0.1:7447",)
    connect: tuple[str, ...] = ()
    multicast: bool = False


class SegmentationConfig(_Section, frozen=True):
    """The energy (equation 3) and how it is brought down.

    `optimiser`: "exact" is its minimum; "icm" the paper's Algorithm 2, which alone has use for
    `settled` and `sweeps_max`.
    `light_std`: relative change of brightness between learning and seeing, and over the object's
    own shades, that the colour model is widened by; 0 leaves it as learnt.
    `presence_min`: probability from which the object counts as found.
    """

    width: Width = 160
    optimiser: Literal["exact", "icm"] = "exact"
    beta: Annotated[float, Meta(ge=0.0, le=1e5)] = 1.0
    background_energy: Positive = 16.6
    light_std: NotNegative = 0.12
    settled: NotNegative = 1e-3
    sweeps_max: Count = 50
    pixels_min: Count = 12
    presence_min: Fraction = 0.52


class GazeConfig(_Section, frozen=True):
    """Head centring: share of the error turned at once, and when it counts as centred."""

    gain: Annotated[float, Meta(gt=0.0, le=1.0)] = 0.7
    tolerance_deg: Positive = 3.0
    speed_deg_s: Positive = 120.0


class ApproachConfig(_Section, frozen=True):
    """Look-then-move: how far at once, and when the goal counts as reached.

    `looks` are taken before each step; more, up to `looks_max` or for `looking_max_s`, while what
    they say is less certain than the step is long. A picture in which the object moved by more
    than `blur_max_px` is no look.
    """

    estimator: Literal["exact", "paper"] = "exact"
    step_max_m: Positive = 0.25
    turn_max_deg: Positive = 30.0
    tolerance_m: Positive = 0.010
    tolerance_deg: Positive = 1.0
    looks: Count = 5
    looks_max: Count = 20
    looking_max_s: Positive = 4.0
    blur_max_px: Positive = 10.0
    settle_s: NotNegative = 0.3
    lost_s: Positive = 5.0
    moves_max: Count = 60

    def __post_init__(self) -> None:
        if self.looks_max < self.looks:
            raise ValueError(f"looks_max {self.looks_max} is less than looks {self.looks}")


class WalkConfig(_Section, frozen=True):
    """Limits that the walk server holds, whoever asks; none beyond what a NAO has ever walked."""

    speed_max_m_s: Annotated[float, Meta(gt=0.0, le=0.4)] = 0.12
    turn_max_rad_s: Annotated[float, Meta(gt=0.0, le=2.6)] = 0.6
    step_max_m: Annotated[float, Meta(gt=0.0, le=2.0)] = 0.40
    step_turn_max_rad: Annotated[float, Meta(gt=0.0, le=3.1416)] = 1.6


class LogConfig(_Section, frozen=True):
    """What goes to stderr."""

    level: Literal["debug", "info", "warning", "error"] = "info"


class DaemonConfig(_Section, frozen=True):
    """The whole file."""

    robot: RobotConfig = RobotConfig()
    sim: SimConfig = SimConfig()
    naoqi: NaoqiConfig = NaoqiConfig()
    lola: LolaConfig = LolaConfig()
    camera: CameraConfig = CameraConfig()
    bus: BusConfig = BusConfig()
    object: ObjectShape | None = None
    segmentation: SegmentationConfig = SegmentationConfig()
    gaze: GazeConfig = GazeConfig()
    approach: ApproachConfig = ApproachConfig()
    walk: WalkConfig = WalkConfig()
    log: LogConfig = LogConfig()


def load_config(path: Path | None) -> DaemonConfig:
    """Read the daemon's file; defaults when there is none. Raises InputError."""
    return DaemonConfig() if path is None else read_toml(path, DaemonConfig)


def state_folder(config: DaemonConfig) -> Path:
    """Where goals and colour models are kept: configured, systemd's, or the user's."""
    if config.robot.state_folder:
        return Path(config.robot.state_folder).expanduser()
    systemd = os.environ.get("STATE_DIRECTORY")
    if systemd:
        return Path(systemd.split(":")[0])
    home = os.environ.get("XDG_STATE_HOME") or "~/.local/state"
    return Path(home).expanduser() / "naod" / config.robot.name
