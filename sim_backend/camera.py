"""The camera as its reader sees it: a grid of frames, late by the latency, some of them lost.

A frame is rendered when somebody reads it; its time, its noise and whether it is lost depend on its
number only.
"""

from __future__ import annotations

import math
import threading

from hal.errors import CameraTimeoutError
from hal.scenario import CameraSection
from hal.types import CameraName, Frame
from sim_backend.clocks import WorldClock
from sim_backend.eye import Eye
from sim_backend.streams import Purpose, stream
from sim_backend.world import World


class SimCamera:
    """`hal.protocols.Camera` on an eye and a clock."""

    def __init__(
        self, eye: Eye, world: World, clock: WorldClock, given: CameraSection, fps: int, seed: int
    ) -> None:
        self._eye, self._world, self._clock = eye, world, clock
        self._drop_rate = given.drop_rate
        self._period_ns = 1e9 / fps
        self._half_ns = round(eye.exposure_s * 0.5e9)
        self._late_ns = self._half_ns + round(given.latency_s * 1e9)
        self._seed = seed
        self._seen = -1
        self._last: Frame | None = None
        self._lock = threading.Lock()

    @property
    def name(self) -> CameraName:
        """Which camera."""
        return self._eye.camera

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return self._eye.size

    def next(self, timeout_s: float) -> Frame:
        """The first frame whose exposure begins from now on. Raises CameraTimeoutError."""
        now_ns = self._clock.now_ns()
        first = self._number_from(now_ns + self._half_ns)
        return self._await(first, now_ns, timeout_s)

    def unseen(self, timeout_s: float) -> Frame:
        """The newest frame not handed out before; waits. Raises CameraTimeoutError."""
        now_ns = self._clock.now_ns()
        newest = self._newest(now_ns, now_ns - self._earliest_ns())
        if newest is not None and newest > self._seen:
            return self._hand_out(newest)
        first = self._number_from(max(now_ns - self._late_ns + 1, self._earliest_ns()))
        return self._await(max(first, self._seen + 1), now_ns, timeout_s)

    def latest(self, max_age_s: float) -> Frame | None:
        """The newest frame if it is not older than `max_age_s`, at once."""
        now_ns = self._clock.now_ns()
        age_ns = max(max_age_s, 0.0) * 1e9 if not math.isnan(max_age_s) else 0.0
        newest = self._newest(now_ns, min(age_ns, now_ns - self._earliest_ns()))
        return None if newest is None else self._hand_out(newest)

    def _earliest_ns(self) -> int:
        """Least middle of an exposure since the robot was last put down."""
        return self._world.placed_ns + self._half_ns

    def _middle_ns(self, number: int) -> int:
        return self._world.start_ns + round((number + 1) * self._period_ns)

    def _number_from(self, middle_ns: int) -> int:
        """The first frame with its middle at a time or later."""
        number = max(0, math.floor((middle_ns - self._world.start_ns) / self._period_ns) - 2)
        while self._middle_ns(number) < middle_ns:
            number += 1
        return number

    def _newest(self, now_ns: int, age_ns: float) -> int | None:
        """The newest frame that has arrived and is not older than `age_ns`."""
        number = self._number_from(now_ns - self._late_ns + 1) - 1
        while number >= 0 and now_ns - self._middle_ns(number) <= age_ns:
            if not self._is_lost(number):
                return number
            number -= 1
        return None

    def _is_lost(self, number: int) -> bool:
        if self._drop_rate <= 0.0:
            return False
        return bool(stream(self._seed, Purpose.DROPS, number).random() < self._drop_rate)

    def _await(self, number: int, now_ns: int, timeout_s: float) -> Frame:
        """Wait for the first frame from a number on that is not lost."""
        limit_ns = now_ns + round(max(timeout_s, 0.0) * 1e9)
        while self._middle_ns(number) + self._late_ns <= limit_ns:
            if not self._is_lost(number):
                # in real time it is rendered while it is, as it were, on its way
                self._clock.sleep_until(self._middle_ns(number) + self._half_ns)
                frame = self._hand_out(number)
                self._clock.sleep_until(self._middle_ns(number) + self._late_ns)
                return frame
            number += 1
        self._clock.sleep_until(limit_ns)
        raise CameraTimeoutError(f"no picture within {timeout_s:g} s")

    def _hand_out(self, number: int) -> Frame:
        with self._lock:
            self._seen = max(self._seen, number)
            if self._last is not None and self._last.sequence == number:
                return self._last
        middle_ns = self._middle_ns(number)
        # in real time the world's own thread may be a little behind
        self._world.run_to(self._clock.now_ns())
        yuyv = self._eye.take(middle_ns, number)
        if yuyv is None:
            raise CameraTimeoutError("the picture is gone: the robot was carried meanwhile")
        yuyv.flags.writeable = False
        frame = Frame(middle_ns, yuyv, self.name, self._eye.exposure_s, number)
        with self._lock:
            self._last = frame
        return frame
