"""The joints and the memory, polled by a thread of their own into a short past.

The angles are as old as half of ALMotion's cycle on average, give or take that half (10 ms), and as
the middle of the round trip, give or take half of that; their stamp says so.
"""

from __future__ import annotations

import logging
import threading
import time
from bisect import bisect_right
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from hal.errors import HalError
from hal.nao.joints import JOINT_INDEX, JOINT_NAMES
from hal.naoqi.channel import Channel
from hal.naoqi.clock import MidpointClock, RoundTrip
from hal.naoqi.errors import NotConnectedError
from hal.naoqi.ids import CYCLE_S
from hal.naoqi.memory import KEYS, NOTHING, Sensed, sensed
from hal.naoqi.session import Session
from hal.types import BodyState

log = logging.getLogger(__name__)

PERIOD_S = 0.025
MEMORY_EVERY = 4
CLOCK_EVERY = 40
CLOCK_FIRST = 8
"""Round trips at once after connecting."""
PAST = 240
GAP_NS = 250_000_000
"""Between samples further apart than this nobody knows how the head stood."""


class Body:
    """`hal.protocols.BodySensors`, and the robot's clock."""

    def __init__(self, channel: Channel, name: str) -> None:
        self._channel = channel
        self._clock_key = f"naod/{name}/clock"
        self._news = threading.Condition()
        self._past: list[BodyState] = []
        self._clock = MidpointClock()
        self._order: NDArray[np.intp] | None = None
        self._turn = 0
        self.sensed: Sensed = NOTHING
        self.error: str | None = None
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._run, name="naoqi-body", daemon=True)

    def start(self) -> None:
        """Begin; raises HalError when the first reading fails."""
        self._poll()
        self._thread.start()

    @property
    def session(self) -> Session:
        """The connection. Raises NotConnectedError."""
        return self._channel.session

    def latest(self) -> BodyState:
        """The newest measurement; while the connection is cut it grows old.

        Raises NotConnectedError if there never was one.
        """
        with self._news:
            if not self._past:
                raise NotConnectedError("the body has not been read yet")
            return self._past[-1]

    def at(self, stamp_ns: int) -> BodyState | None:
        """The measurement at a time, interpolated; None outside the past, or in a gap of it."""
        with self._news:
            index = bisect_right(self._past, stamp_ns, key=lambda state: state.stamp_ns)
            if index == 0 or (index == len(self._past) and self._past[-1].stamp_ns < stamp_ns):
                return None
            before, after = self._past[index - 1], self._past[min(index, len(self._past) - 1)]
        if after.stamp_ns - before.stamp_ns > GAP_NS:
            return None
        return _between(before, after, stamp_ns)

    def await_at(self, stamp_ns: int, timeout_s: float) -> bool:
        """Wait until the past reaches up to a time; false if it does not come to that."""
        with self._news:
            return self._news.wait_for(
                lambda: bool(self._past) and self._past[-1].stamp_ns >= stamp_ns, timeout_s
            )

    def clock_offset(self) -> tuple[int, int] | None:
        """The robot's clock minus ours, and its uncertainty, in ns; None while unknown."""
        with self._news:
            return self._clock.estimate(time.monotonic_ns())

    def close(self) -> None:
        """End the thread and the connection. May be called twice."""
        self._closing.set()
        if self._thread.ident is not None:
            self._thread.join(timeout=5.0)
        self._channel.close()

    def _run(self) -> None:
        due_s = time.monotonic()
        while not self._closing.wait(max(0.0, due_s - time.monotonic())):
            try:
                self._poll()
                self.error = None
            except HalError as error:
                if self.error is None:
                    log.warning("the body cannot be read: %s", error)
                self.error = str(error)
                self._channel.note(error)
            due_s = max(due_s + PERIOD_S, time.monotonic())

    def _poll(self) -> None:
        if self._channel.ensure():
            self._order = None
        session = self._channel.session
        if self._order is None:
            self._begin(session)
        sent_ns = time.monotonic_ns()
        call = session.post("ALMotion", "getAngles", "Body", True)
        memory = None
        if self._turn % MEMORY_EVERY == 0:
            memory = session.post("ALMemory", "getListData", list(KEYS))
        angles = call.result()
        heard_ns = time.monotonic_ns()
        if memory is not None:
            self._take_memory(memory.result())
        self._record((sent_ns + heard_ns) // 2, angles)
        self._turn += 1
        if self._turn % CLOCK_EVERY == 0:
            self._compare_clocks(session)
        self._channel.answered()

    def _begin(self, session: Session) -> None:
        """After connecting: which joints there are, and what time it is there."""
        names = session.call("ALMotion", "getBodyNames", "Body")
        order = np.array([JOINT_INDEX.get(str(name), -1) for name in names], dtype=np.intp)
        with self._news:
            self._clock.forget()
        for _ in range(CLOCK_FIRST):
            self._compare_clocks(session)
        self._order = order

    def _take_memory(self, values: object) -> None:
        try:
            self.sensed = sensed(values if isinstance(values, list | tuple) else ())
        except ValueError as error:
            raise HalError(str(error)) from None

    def _record(self, middle_ns: int, angles: object) -> None:
        order = self._order
        if order is None or not isinstance(angles, list | tuple) or len(angles) != len(order):
            raise HalError("ALMotion gives other angles than it has joints")
        measured = np.zeros(len(JOINT_NAMES))
        known = order >= 0
        measured[order[known]] = np.array(angles, dtype=np.float64)[known]
        if not np.isfinite(measured).all():
            raise HalError("ALMotion gives an angle that is not finite")
        memory = self.sensed
        state = BodyState(
            stamp_ns=middle_ns - round(CYCLE_S * 0.5e9),
            angles_rad=measured,
            gyro_rad_s=memory.gyro_rad_s,
            accel_m_s2=memory.accel_m_s2,
            torso_roll_pitch_rad=memory.tilt_rad,
            fsr_kg=memory.fsr_kg,
            battery=memory.battery,
            temperature_max_c=memory.temperature_max_c,
        )
        with self._news:
            if self._past and state.stamp_ns <= self._past[-1].stamp_ns:
                return
            self._past.append(state)
            del self._past[:-PAST]
            self._news.notify_all()

    def _compare_clocks(self, session: Session) -> None:
        """One round trip; robots that refuse it are met too, their pictures' arrival has to do."""
        try:
            sent_ns = time.monotonic_ns()
            session.call("ALMemory", "insertData", self._clock_key, 0)
            heard_ns = time.monotonic_ns()
            stamped = session.call("ALMemory", "getTimestamp", self._clock_key)
            seconds, micros = int(stamped[1]), int(stamped[2])
        except NotConnectedError:
            raise
        except (HalError, TypeError, ValueError, IndexError) as error:
            log.debug("the clocks cannot be compared: %s", error)
            return
        trip = RoundTrip(sent_ns, heard_ns, seconds * 1_000_000_000 + micros * 1000)
        with self._news:
            self._clock.add(trip)


def _between(a: BodyState, b: BodyState, stamp_ns: int) -> BodyState:
    span = b.stamp_ns - a.stamp_ns
    share = (stamp_ns - a.stamp_ns) / span if span > 0 else 0.0

    def mixed(
        of: Callable[[BodyState], NDArray[np.float64]],
    ) -> NDArray[np.float64]:
        return (1.0 - share) * of(a) + share * of(b)

    return BodyState(
        stamp_ns=stamp_ns,
        angles_rad=mixed(lambda state: state.angles_rad),
        gyro_rad_s=mixed(lambda state: state.gyro_rad_s),
        accel_m_s2=mixed(lambda state: state.accel_m_s2),
        torso_roll_pitch_rad=mixed(lambda state: state.torso_roll_pitch_rad),
        fsr_kg=mixed(lambda state: state.fsr_kg),
        battery=b.battery,
        temperature_max_c=b.temperature_max_c,
    )
