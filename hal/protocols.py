"""One small interface per capability. Commands return what was really sent, after clipping."""

from __future__ import annotations

from typing import Protocol

from hal.types import BodyState, CameraName, Frame, HeadAngles, PlanarMotion, RobotInfo, WalkStatus


class Clock(Protocol):
    """The robot's monotonic clock; in lock-step simulation it is virtual."""

    def now_ns(self) -> int:
        """Time now, in nanoseconds."""
        ...

    def sleep_until(self, deadline_ns: int) -> None:
        """Return once `now_ns()` has reached the deadline."""
        ...


class Camera(Protocol):
    """One of the head's cameras: three ways to read it."""

    @property
    def name(self) -> CameraName:
        """Which camera."""
        ...

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        ...

    def next(self, timeout_s: float) -> Frame:
        """Wait for the next picture to be taken. Raises CameraTimeoutError."""
        ...

    def unseen(self, timeout_s: float) -> Frame:
        """The newest picture not handed out before; waits if there is none. CameraTimeoutError."""
        ...

    def latest(self, max_age_s: float) -> Frame | None:
        """The newest picture if it is not older than `max_age_s`, at once."""
        ...


class Head(Protocol):
    """The two joints of the neck."""

    def look(self, target: HeadAngles, speed_rad_s: float) -> HeadAngles:
        """Turn towards `target`; the newest call wins. Returns the target after clipping.

        Raises MotionRefusedError when a value is not finite.
        """
        ...


class Walk(Protocol):
    """The walk primitive. Every motion ends by itself at its deadline unless renewed."""

    def move_to(self, step: PlanarMotion, valid_for_s: float) -> PlanarMotion:
        """Walk by a displacement from where the base is now, then stand.

        Returns at once, with the displacement after clipping. Raises MotionRefusedError.
        """
        ...

    def set_velocity(self, velocity: PlanarMotion, valid_for_s: float) -> PlanarMotion:
        """Walk at a velocity. Returns it after clipping. Raises MotionRefusedError."""
        ...

    def renew(self, valid_for_s: float) -> None:
        """Let the present motion go on for as long again; nothing if there is none."""
        ...

    def stop(self) -> None:
        """End on both feet as soon as is safe."""
        ...

    def status(self) -> WalkStatus:
        """What the walk does now."""
        ...


class BodySensors(Protocol):
    """Joint angles, inertial unit, foot contact, battery."""

    def latest(self) -> BodyState:
        """The newest measurement."""
        ...

    def at(self, stamp_ns: int) -> BodyState | None:
        """The measurement at a time, interpolated; None outside the recorded past."""
        ...


class Robot(Protocol):
    """A robot, opened. Closing it leaves it standing still."""

    @property
    def info(self) -> RobotInfo: ...
    @property
    def clock(self) -> Clock: ...
    @property
    def camera(self) -> Camera: ...
    @property
    def head(self) -> Head: ...
    @property
    def walk(self) -> Walk: ...
    @property
    def body(self) -> BodySensors: ...

    def close(self) -> None:
        """Stop, let go of the hardware. May be called twice."""
        ...
