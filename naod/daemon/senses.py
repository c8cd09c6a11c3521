"""What the robot senses at one tick: an unseen picture with the body at its time."""

from __future__ import annotations

from hal.errors import CameraTimeoutError, HalError
from hal.protocols import Robot
from hal.types import BodyState, Frame
from naod.loop.around import around
from naod.loop.types import Observation, Request
from naod.messages import WalkState

FRAME_AGE_MAX_S = 0.5


class Senses:
    """Reads a robot; hands out every picture once."""

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._last: int | None = None
        self.camera_error: str | None = None

    def observe(self, walk: WalkState, requests: tuple[Request, ...]) -> Observation:
        """One tick's observation. Raises HalError when the body does not answer."""
        newest = self._robot.body.latest()
        frame = self._frame()
        if frame is None:
            return Observation(None, newest, walk, requests)
        body = self._body_at(frame, newest)
        if body is None:
            return Observation(None, newest, walk, requests)
        self._last = frame.sequence
        return Observation(frame, body, walk, requests, around(self._robot.body, frame))

    def _frame(self) -> Frame | None:
        self.camera_error = None
        try:
            frame = self._robot.camera.latest(FRAME_AGE_MAX_S)
        except CameraTimeoutError:
            return None
        except HalError as error:
            self.camera_error = str(error)
            return None
        return None if frame is None or frame.sequence == self._last else frame

    def _body_at(self, frame: Frame, newest: BodyState) -> BodyState | None:
        """The body when the picture was taken; None when nobody knows how the head stood then."""
        return newest if frame.stamp_ns == newest.stamp_ns else self._robot.body.at(frame.stamp_ns)
