"""The robot on LoLA as the daemon sees it, opened by name through `hal.backends`."""

from __future__ import annotations

import contextlib
import math

from hal.backends import OpenOptions
from hal.between import state_between
from hal.clock import MonotonicClock
from hal.errors import BackendError, MotionRefusedError
from hal.health import Examined, Finding
from hal.lola.channel import LeaveWish, LookWish, RenewWish, StepWish, StopWish, VelocityWish
from hal.lola.checkup import findings
from hal.lola.line import Line
from hal.lola.options import checked
from hal.lola.spawn import hired
from hal.nao.head_limits import HEAD_SPEED_MAX_RAD_S, clip_head
from hal.protocols import Robot
from hal.types import BodyState, HeadAngles, PlanarMotion, RobotInfo, WalkStatus
from hal.video.slot import VideoCamera
from hal.video.source import open_camera

FIRST_MESSAGE_S = 5.0
CLOSE_S = 8.0
"""Sitting down takes about four seconds."""

STALE_NS = 500_000_000
"""Angles older than this are nobody's (B-Human holds a camera matrix invalid then)."""

LOOK_SPARE_S = 0.5
LOOK_MAX_S = 5.0


class LolaHead:
    """`hal.protocols.Head`. A turn that has not ended in its time is given up."""

    def __init__(self, line: Line, clock: MonotonicClock, body: LolaBody) -> None:
        self._line, self._clock, self._body = line, clock, body

    def look(self, target: HeadAngles, speed_rad_s: float) -> HeadAngles:
        """Turn towards `target`; see `hal.protocols.Head`."""
        if not (math.isfinite(speed_rad_s) and speed_rad_s > 0.0):
            raise MotionRefusedError(f"head speed is not a positive number: {speed_rad_s}")
        sent = clip_head(target)
        refusal = self._line.status().head_refusal
        if refusal is not None:
            raise MotionRefusedError(refusal)
        yaw, pitch = self._body.latest().angles_rad[:2]
        way = max(abs(sent.yaw_rad - float(yaw)), abs(sent.pitch_rad - float(pitch)))
        takes_s = min(way / min(speed_rad_s, *HEAD_SPEED_MAX_RAD_S) + LOOK_SPARE_S, LOOK_MAX_S)
        deadline_ns = self._clock.now_ns() + round(takes_s * 1e9)
        self._line.send(LookWish(sent.yaw_rad, sent.pitch_rad, speed_rad_s, deadline_ns))
        return sent


class LolaWalk:
    """`hal.protocols.Walk`: whether there is one is for the process's engine to say."""

    def __init__(self, line: Line, clock: MonotonicClock) -> None:
        self._line, self._clock = line, clock

    def move_to(self, step: PlanarMotion, valid_for_s: float) -> PlanarMotion:
        """Walk by a displacement; see `hal.protocols.Walk`."""
        deadline_ns = self._checked(step, valid_for_s)
        self._line.send(StepWish(step.x, step.y, step.yaw, deadline_ns))
        return step

    def set_velocity(self, velocity: PlanarMotion, valid_for_s: float) -> PlanarMotion:
        """Walk at a velocity; see `hal.protocols.Walk`."""
        if velocity == PlanarMotion(0.0, 0.0, 0.0):
            self.stop()
            return velocity
        deadline_ns = self._checked(velocity, valid_for_s)
        self._line.send(VelocityWish(velocity.x, velocity.y, velocity.yaw, deadline_ns))
        return velocity

    def renew(self, valid_for_s: float) -> None:
        """Let the present motion go on; see `hal.protocols.Walk`."""
        self._line.send(RenewWish(self._deadline_ns(valid_for_s)))

    def stop(self) -> None:
        """End on both feet as soon as is safe."""
        self._line.send(StopWish())

    def status(self) -> WalkStatus:
        """What the walk does now; a LoLA that is away walks nobody. Raises BackendError."""
        status = self._line.status()
        return WalkStatus(
            stamp_ns=self._clock.now_ns(),
            moving=status.moving,
            fallen=status.fallen or status.lifted,
            velocity=PlanarMotion(*status.velocity),
            odometry=PlanarMotion(*status.odometry),
        )

    def _checked(self, motion: PlanarMotion, valid_for_s: float) -> int:
        if not all(math.isfinite(value) for value in (motion.x, motion.y, motion.yaw)):
            raise MotionRefusedError(f"motion is not finite: {motion}")
        deadline_ns = self._deadline_ns(valid_for_s)
        refusal = self._line.status().refusal
        if refusal is not None:
            raise MotionRefusedError(refusal)
        return deadline_ns

    def _deadline_ns(self, valid_for_s: float) -> int:
        if not (math.isfinite(valid_for_s) and valid_for_s > 0.0):
            raise MotionRefusedError(f"a motion's validity is not positive: {valid_for_s} s")
        return self._clock.now_ns() + round(valid_for_s * 1e9)


class LolaBody:
    """`hal.protocols.BodySensors`. A measurement's stamp is when its message came.

    Assumption: LoLA sends what it has just read, so the stamp is late by less than its cycle.
    """

    def __init__(self, line: Line, clock: MonotonicClock) -> None:
        self._line, self._clock = line, clock

    def latest(self) -> BodyState:
        """The newest measurement. Raises BackendError when it is old, with the reason."""
        newest = self._line.shared.newest()
        if newest is None or self._clock.now_ns() - newest.stamp_ns > STALE_NS:
            status = self._line.status()
            raise BackendError(status.refusal or "LoLA has gone silent")
        return newest

    def at(self, stamp_ns: int) -> BodyState | None:
        """The measurement at a time, interpolated; None outside the recorded past."""
        found = self._line.shared.around(stamp_ns)
        return None if found is None else state_between(*found, stamp_ns)


class LolaRobot:
    """`hal.protocols.Robot` on a line to the process and a camera."""

    def __init__(self, info: RobotInfo, line: Line, camera: VideoCamera) -> None:
        self._info, self._line, self._camera = info, line, camera
        self._clock = MonotonicClock()
        self._body = LolaBody(line, self._clock)
        self._head = LolaHead(line, self._clock, self._body)
        self._walk = LolaWalk(line, self._clock)

    @property
    def info(self) -> RobotInfo:
        """Which robot this is."""
        return self._info

    @property
    def clock(self) -> MonotonicClock:
        """The machine's."""
        return self._clock

    @property
    def camera(self) -> VideoCamera:
        """The camera that was asked for."""
        return self._camera

    @property
    def head(self) -> LolaHead:
        """The neck's two joints."""
        return self._head

    @property
    def walk(self) -> LolaWalk:
        """The walk primitive, as far as there is one."""
        return self._walk

    @property
    def body(self) -> LolaBody:
        """The body's sensors."""
        return self._body

    def examine(self) -> list[Finding]:
        """What is worth telling; see `hal.health.Examined`."""
        found = findings(self._line)
        return found + list(self._camera.examine() if isinstance(self._camera, Examined) else ())

    def close(self) -> None:
        """Sit down, let go, hang up; waits for it. May be called twice."""
        self._camera.close()
        with contextlib.suppress(MotionRefusedError):
            self._line.send(LeaveWish())
        self._line.close(CLOSE_S)


def open_robot(options: OpenOptions) -> Robot:
    """Open the robot. Raises BackendError, with one line."""
    told, device, controls = checked(options)
    line = Line(*hired(told))
    try:
        status = line.first_status(FIRST_MESSAGE_S)
        if not status.connected:
            raise BackendError(
                f"{status.refusal}; is it a V6 with a RoboCup image, with /home/nao/robocup.conf, "
                "and no other program on LoLA?"
            )
        size = (options.width, options.height)
        camera = open_camera(
            device, options.camera, size, options.fps, MonotonicClock(), controls=controls
        )
    except BaseException:
        with contextlib.suppress(MotionRefusedError):
            line.send(LeaveWish())
        line.close(CLOSE_S)
        raise
    info = RobotInfo(options.name, options.version, "lola", False)
    return LolaRobot(info, line, camera)
