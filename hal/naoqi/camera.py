"""One head camera by ALVideoDevice, read by a thread of its own over a connection of its own."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import suppress

from hal.errors import BackendError, CameraTimeoutError, HalError
from hal.naoqi.channel import Channel
from hal.naoqi.clock import EarliestArrival, is_plausible
from hal.naoqi.controls import Locked, lock_controls, restore_controls
from hal.naoqi.errors import CallRefusedError, NotConnectedError, ServiceMissingError
from hal.naoqi.ids import (
    CAMERA_IDS,
    RESOLUTION_NAMES,
    RESOLUTIONS,
    STAMP_AFTER_MIDDLE_S,
    YUV422,
)
from hal.naoqi.image import Picture, picture_from
from hal.naoqi.session import Session
from hal.types import CameraName, Frame

log = logging.getLogger(__name__)

IMAGE_S = 2.0
"""A picture of 1280x960 over a slow network takes long."""
SETTLE_S = 1.0
"""Automatic exposure and white balance are given so long before they are frozen."""
BODY_S = 0.1
NONE_MAX = 60
"""So many askings in a row without a picture, and the camera is subscribed anew."""
DOUBTS_MAX = 10
"""So many pictures in a row from an impossible time, and their clock is another one. A single one
was only long under way."""
FAILED = 10
"""A refused asking counts as so many."""
EXPOSURE_S = 0.010
"""NAOqi's exposure has no published unit; this is what rooms need."""


class NaoqiCamera:
    """`hal.protocols.Camera`."""

    def __init__(
        self,
        channel: Channel,
        name: str,
        camera: CameraName,
        size: tuple[int, int],
        fps: int,
        clock_offset: Callable[[], tuple[int, int] | None],
        await_body: Callable[[int, float], bool],
        controls: Mapping[str, int],
    ) -> None:
        if size not in RESOLUTION_NAMES:
            known = ", ".join(f"{w}x{h}" for w, h in RESOLUTION_NAMES)
            raise BackendError(f"no camera size {size[0]}x{size[1]}; known: {known}")
        self._channel, self._camera, self._size, self._fps = channel, camera, size, fps
        self._subscriber = f"naod_{name}"
        self._key = f"naod/{name}/camera_{camera}"
        self._clock_offset, self._await_body = clock_offset, await_body
        self._controls = controls
        self._news = threading.Condition()
        self._frame: Frame | None = None
        self._handed_out = -1
        self._sequence = 0
        self._handle = ""
        self._subscribed_s = 0.0
        self._robot_ns = 0
        self._none = 0
        self._doubts = 0
        self._arrival = EarliestArrival(round(1e9 / fps))
        self.locked: Locked | None = None
        self.other_clock = False
        self.error: str | None = None
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._run, name="naoqi-camera", daemon=True)

    @property
    def name(self) -> CameraName:
        """Which camera."""
        return self._camera

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return self._size

    def start(self) -> None:
        """Subscribe and begin. Raises HalError."""
        if self._channel.ensure():
            self._subscribe(self._channel.session)
        self._thread.start()

    def next(self, timeout_s: float) -> Frame:
        """The first picture taken from now on. Raises CameraTimeoutError."""
        now_ns = time.monotonic_ns()
        return self._await(lambda frame: frame.stamp_ns >= now_ns, timeout_s)

    def unseen(self, timeout_s: float) -> Frame:
        """The newest picture not handed out before; waits. Raises CameraTimeoutError."""
        return self._await(lambda frame: frame.sequence > self._handed_out, timeout_s)

    def latest(self, max_age_s: float) -> Frame | None:
        """The newest picture if it is not older than `max_age_s`, at once.

        Raises NotConnectedError when pictures do not come because something is wrong.
        """
        with self._news:
            frame, error = self._frame, self.error
            fresh = frame is not None and (
                time.monotonic_ns() - frame.stamp_ns <= max(max_age_s, 0.0) * 1e9
            )
            if frame is not None and fresh:
                self._handed_out = max(self._handed_out, frame.sequence)
                return frame
        if error is not None:
            raise NotConnectedError(error)
        return None

    def close(self) -> None:
        """Put the controls back, unsubscribe, end the thread. May be called twice."""
        self._closing.set()
        if self._thread.ident is not None:
            self._thread.join(timeout=IMAGE_S + 3.0)
        try:
            session = self._channel.session
            self._let_go(session)
        except HalError as error:
            if self._handle:
                log.warning("the camera could not be put back: %s", error)
        self._handle = ""
        self._channel.close()

    def _await(self, is_wanted: Callable[[Frame], bool], timeout_s: float) -> Frame:
        with self._news:

            def found() -> bool:
                return self._frame is not None and is_wanted(self._frame)

            if not self._news.wait_for(found, max(timeout_s, 0.0)):
                why = f": {self.error}" if self.error else ""
                raise CameraTimeoutError(f"no picture within {timeout_s:g} s{why}")
            assert self._frame is not None
            self._handed_out = max(self._handed_out, self._frame.sequence)
            return self._frame

    def _run(self) -> None:
        while not self._closing.is_set():
            try:
                if self._channel.ensure():
                    self._subscribe(self._channel.session)
                wait_s = self._fetch(self._channel.session)
                self.error = None
                self._channel.answered()
            except HalError as error:
                if self.error is None:
                    log.warning("no picture: %s", error)
                self.error = str(error)
                self._channel.note(error)
                self._note_none(FAILED)
                wait_s = 0.1
            self._closing.wait(wait_s)

    def _subscribe(self, session: Session) -> None:
        self._forget_stale(session)
        handle = session.call(
            "ALVideoDevice",
            "subscribeCamera",
            self._subscriber,
            CAMERA_IDS[self._camera],
            RESOLUTIONS[RESOLUTION_NAMES[self._size]],
            YUV422,
            self._fps,
        )
        if not isinstance(handle, str) or not handle:
            raise CallRefusedError(
                f"ALVideoDevice gives no {self._camera} camera at {self._size[0]}x{self._size[1]}"
            )
        self._handle, self._subscribed_s = handle, time.monotonic()
        self._robot_ns, self._none = 0, 0
        self.locked = None
        self.other_clock, self._doubts = False, 0
        self._arrival.forget()

    def _forget_stale(self, session: Session) -> None:
        """Subscriptions of a life before: NAOqi keeps no more than six of a name."""
        try:
            names = session.call("ALVideoDevice", "getSubscribers")
        except (CallRefusedError, ServiceMissingError) as error:
            log.warning("stale subscriptions cannot be looked for: %s", error)
            return
        for name in names if isinstance(names, list | tuple) else ():
            base, _, number = str(name).rpartition("_")
            if base == self._subscriber and number.isdigit():
                log.info("unsubscribing %s, left by a life before", name)
                session.call("ALVideoDevice", "unsubscribe", str(name))

    def _fetch(self, session: Session) -> float:
        """Ask for a picture; how long to wait before the next time."""
        result = session.call("ALVideoDevice", "getImageRemote", self._handle, timeout_s=IMAGE_S)
        heard_ns = time.monotonic_ns()
        picture = picture_from(result, *self._size)
        # not everywhere offered, nor mandatory
        with suppress(ServiceMissingError):
            session.post("ALVideoDevice", "releaseImage", self._handle)
        period_s = 1.0 / self._fps
        if picture is None or picture.stamp_ns == self._robot_ns:
            self._note_none(1)
            return period_s / 5.0
        self._none = 0
        self._robot_ns = picture.stamp_ns
        if self._is_settled(session):
            self._hand_in(picture, heard_ns)
        # a little before the next one is due
        return max(0.0, 0.8 * period_s - (time.monotonic_ns() - heard_ns) / 1e9)

    def _note_none(self, count: int) -> None:
        self._none += count
        if self._none >= NONE_MAX:
            self._none = 0
            self._channel.drop("ALVideoDevice gives no pictures; subscribing anew")

    def _is_settled(self, session: Session) -> bool:
        """Whether the controls are locked; locks them when that is due."""
        if self.locked is None and time.monotonic() - self._subscribed_s >= SETTLE_S:
            self.locked = lock_controls(
                session, CAMERA_IDS[self._camera], self._key, self._controls
            )
            return False
        return self.locked is not None

    def _hand_in(self, picture: Picture, heard_ns: int) -> None:
        after_ns = round(STAMP_AFTER_MIDDLE_S[self._camera] * 1e9)
        offset_ns = self._offset_ns(picture.stamp_ns, heard_ns)
        if offset_ns is None:
            return
        stamp_ns = min(picture.stamp_ns - offset_ns, heard_ns) - after_ns
        # a picture is of use only together with the joints at its time
        self._await_body(stamp_ns, BODY_S)
        with self._news:
            if self._frame is not None and stamp_ns <= self._frame.stamp_ns:
                return
            self._sequence += 1
            self._frame = Frame(stamp_ns, picture.yuyv, self._camera, EXPOSURE_S, self._sequence)
            self._news.notify_all()

    def _offset_ns(self, stamp_ns: int, heard_ns: int) -> int | None:
        """The pictures' clock minus ours; None for a picture of which that is in doubt."""
        self._arrival.add(stamp_ns, heard_ns)
        known = self._clock_offset()
        if known is not None and not self.other_clock:
            offset_ns, uncertainty_ns = known
            if is_plausible(heard_ns - (stamp_ns - offset_ns), uncertainty_ns):
                self._doubts = 0
                return offset_ns
            self._doubts += 1
            if self._doubts < DOUBTS_MAX:
                return None
            log.warning("the pictures' clock is not ALMemory's; aligned by their arrival instead")
            self.other_clock = True
        estimate = self._arrival.estimate()
        return None if estimate is None else estimate[0]

    def _let_go(self, session: Session) -> None:
        if self.locked is not None:
            before, self.locked = self.locked.before, None
            restore_controls(session, CAMERA_IDS[self._camera], self._key, before)
        if self._handle:
            session.call("ALVideoDevice", "unsubscribe", self._handle)
