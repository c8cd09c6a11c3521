"""The robot, opened by name through `hal.backends`."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable

from hal.backends import OpenOptions
from hal.errors import BackendError, HalError
from hal.health import Finding
from hal.naoqi.body import Body
from hal.naoqi.camera import NaoqiCamera
from hal.naoqi.channel import Channel
from hal.naoqi.examination import findings
from hal.naoqi.guard import Guard
from hal.naoqi.head import NaoqiHead
from hal.naoqi.life import Household
from hal.naoqi.options import NaoqiOptions, checked
from hal.naoqi.stance import Stance
from hal.naoqi.walk import NaoqiWalk
from hal.types import RobotInfo

log = logging.getLogger(__name__)


class NaoqiClock:
    """`hal.protocols.Clock`: this machine's monotonic clock, to which all stamps are brought."""

    def now_ns(self) -> int:
        """Monotonic time in ns."""
        return time.monotonic_ns()

    def sleep_until(self, deadline_ns: int) -> None:
        """Return once `now_ns` has reached the deadline."""
        while (left := deadline_ns - time.monotonic_ns()) > 0:
            time.sleep(left / 1e9)


class NaoqiRobot:
    """`hal.protocols.Robot`. The constructor only puts the parts together; `start` connects."""

    def __init__(self, options: OpenOptions, told: NaoqiOptions) -> None:
        def channel(purpose: str) -> Channel:
            return Channel(told.url, told.login, purpose)

        self._info = RobotInfo(options.name, options.version, "naoqi", False)
        self._clock = NaoqiClock()
        self._guard = Guard(told.url, told.login)
        self._body = Body(channel("body"), options.name)
        walking = channel("walk")
        household = Household(options.name)
        stance = Stance(lambda: self._body.sensed, told.wake_up)
        self._walk = NaoqiWalk(walking, self._guard, household, stance, told.velocity_by_leads)
        self._head = NaoqiHead(walking, self._walk)
        self._camera = NaoqiCamera(
            channel("camera"),
            options.name,
            options.camera,
            (options.width, options.height),
            options.fps,
            self._body.clock_offset,
            self._body.await_at,
            told.controls,
        )

    def start(self) -> None:
        """Connect, stop whatever moves, take the robot over. Raises HalError."""
        self._guard.start()
        self._body.start()
        self._walk.start()
        self._camera.start()
        if not self._guard.await_ready():
            raise BackendError("the walk's watchdog does not come to life")

    @property
    def info(self) -> RobotInfo:
        """Which robot this is."""
        return self._info

    @property
    def clock(self) -> NaoqiClock:
        """This machine's monotonic clock."""
        return self._clock

    @property
    def camera(self) -> NaoqiCamera:
        """The head camera that was asked for."""
        return self._camera

    @property
    def head(self) -> NaoqiHead:
        """The neck's two joints."""
        return self._head

    @property
    def walk(self) -> NaoqiWalk:
        """The walk."""
        return self._walk

    @property
    def body(self) -> Body:
        """The body's sensors."""
        return self._body

    @property
    def guard(self) -> Guard:
        """The walk's watchdog."""
        return self._guard

    def examine(self) -> list[Finding]:
        """What is worth telling; see `hal.health.Examined`."""
        try:
            session = self._body.session
        except HalError as error:
            advice = "does NAOqi run there, and is the network well?"
            return [Finding("naoqi", "fail", str(error), advice)]
        return findings(session, self._body, self._walk, self._camera, self._guard)

    def close(self) -> None:
        """Stop; put everything back; let go. May be called twice."""
        steps: tuple[Callable[[], None], ...] = (
            self._walk.halt,
            self._camera.close,
            self._head.relax,
            self._walk.close,
            self._body.close,
            self._guard.close,
        )
        for step in steps:
            try:
                step()
            except HalError as error:
                log.warning("closing: %s", error)


def open_robot(options: OpenOptions) -> NaoqiRobot:
    """Open a NAO with its stock system. Raises BackendError or another HalError, one line each."""
    robot = NaoqiRobot(options, checked(options))
    try:
        robot.start()
    except HalError:
        robot.close()
        raise
    return robot
