"""The newest picture of a source that runs by itself, and a camera that reads it three ways."""

from __future__ import annotations

import threading
import time
from typing import Protocol

from hal.errors import CameraTimeoutError
from hal.health import Finding
from hal.protocols import Camera, Clock
from hal.types import CameraName, Frame


class VideoCamera(Camera, Protocol):
    """A camera that was opened by itself, and has to be closed."""

    def close(self) -> None:
        """Let go of it; what was changed is put back. May be called twice."""
        ...

    def examine(self) -> list[Finding]:
        """How it is; see `hal.health.Examined`."""
        ...


class FrameSlot:
    """Holds one frame, the newest: whoever comes late never finds a backlog."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._frame: Frame | None = None
        self._closed = False
        self.received = 0

    def put(self, frame: Frame) -> None:
        """Replace what is there."""
        with self._changed:
            self._frame = frame
            self.received += 1
            self._changed.notify_all()

    def peek(self) -> Frame | None:
        """What is there."""
        with self._changed:
            return self._frame

    def wait_for_other(
        self, known: Frame | None, from_ns: int | None, timeout_s: float
    ) -> Frame | None:
        """A frame that is not `known`, exposed from `from_ns` on; None when there is none in time.

        Raises CameraTimeoutError when the slot is closed.
        """

        def is_there() -> bool:
            frame = self._frame
            if self._closed:
                return True
            if frame is None or frame is known:
                return False
            return from_ns is None or frame.stamp_ns - round(0.5e9 * frame.exposure_s) >= from_ns

        with self._changed:
            there = self._changed.wait_for(is_there, max(timeout_s, 0.0))
            if self._closed:
                raise CameraTimeoutError("the camera is closed")
            return self._frame if there else None

    def close(self) -> None:
        """Wake whoever waits."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()


class SlotCamera:
    """`hal.protocols.Camera` on a slot that somebody else's thread fills.

    The frames' stamps and the clock are those of the machine, CLOCK_MONOTONIC.
    """

    def __init__(self, name: CameraName, size: tuple[int, int], clock: Clock) -> None:
        self.slot = FrameSlot()
        self._name: CameraName = name
        self._size = size
        self._clock = clock
        self._lock = threading.Lock()
        self._seen: Frame | None = None

    @property
    def name(self) -> CameraName:
        """Which camera."""
        return self._name

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return self._size

    def next(self, timeout_s: float) -> Frame:
        """The first frame whose exposure begins from now on. Raises CameraTimeoutError."""
        return self._await(None, self._clock.now_ns(), timeout_s)

    def unseen(self, timeout_s: float) -> Frame:
        """The newest frame not handed out before; waits. Raises CameraTimeoutError."""
        with self._lock:
            seen = self._seen
        return self._await(seen, None, timeout_s)

    def latest(self, max_age_s: float) -> Frame | None:
        """The newest frame if it is not older than `max_age_s`, at once."""
        frame = self.slot.peek()
        if frame is None or not (self._clock.now_ns() - frame.stamp_ns) / 1e9 <= max_age_s:
            return None
        return self._handed_out(frame)

    def _await(self, known: Frame | None, from_ns: int | None, timeout_s: float) -> Frame:
        begun = time.monotonic()
        frame = self.slot.wait_for_other(known, from_ns, timeout_s)
        if frame is None:
            waited = time.monotonic() - begun
            raise CameraTimeoutError(f"no picture of the {self._name} camera within {waited:.2g} s")
        return self._handed_out(frame)

    def _handed_out(self, frame: Frame) -> Frame:
        with self._lock:
            self._seen = frame
        return frame
