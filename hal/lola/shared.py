"""Memory that the process of LoLA and its client share: measurements one way, a heartbeat back.

Nothing in it is ever waited for. Each record has a count that is odd while it is being written; a
reader that finds it odd, or changed when it has read, reads again. The memory has no name: whoever
holds the file descriptor has it, and it is gone with the last of them.
"""

from __future__ import annotations

import mmap
import os
import time

import msgspec
import numpy as np
from numpy.typing import NDArray

from hal.errors import BackendError
from hal.lola.engine import Phase
from hal.lola.modes import Mode
from hal.lola.sensors import Sensors
from hal.types import BodyState

Array = NDArray[np.float64]

SLOTS = 512
"""Six seconds of measurements."""

_HEAD_INTS = 8
_COUNT, _BEAT, _STATUS_SEQ, _STATUS_LENGTH = range(4)
_STATUS_BYTES = 4096
_SLOT_INTS, _SLOT_FLOATS = 4, 44
_SEQ, _STAMP, _ANSWERED, _NUMBER = range(4)
_HEADER_BYTES = 8 * _HEAD_INTS + _STATUS_BYTES
_SLOT_BYTES = 8 * (_SLOT_INTS + _SLOT_FLOATS)
_TRIES = 1000


class LolaStatus(msgspec.Struct, frozen=True):
    """What the process is at, at `stamp_ns`.

    `refusal` and `head_refusal`: why walk and head are refused now; None if they are not. `hot`:
    joints whose motor's own status is above regular. `ticks` answered, `late` more than 8 ms after
    they came; `bad` messages; `connections` to LoLA since start.
    """

    stamp_ns: int
    connected: bool
    real_time: bool
    mode: Mode | None = None
    phase: Phase | None = None
    fallen: bool = False
    lifted: bool = False
    moving: bool = False
    leaving: bool = False
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    odometry: tuple[float, float, float] = (0.0, 0.0, 0.0)
    refusal: str | None = "LoLA has not answered yet"
    head_refusal: str | None = "LoLA has not answered yet"
    trouble: str = ""
    hot: tuple[str, ...] = ()
    soft: tuple[str, ...] = ()
    body_id: str = ""
    version: str = ""
    battery_current_a: float = 0.0
    ticks: int = 0
    late: int = 0
    bad: int = 0
    connections: int = 0


_STATUS = msgspec.msgpack.Decoder(LolaStatus)


def body_values(sensors: Sensors) -> Array:
    """What a slot holds of a message, (44,)."""
    return np.concatenate(
        [
            sensors.angles_rad,
            sensors.gyro_rad_s,
            sensors.accel_m_s2,
            sensors.torso_roll_pitch_rad,
            sensors.fsr_kg,
            [sensors.battery, sensors.temperature_c.max()],
        ]
    )


def _body_state(stamp_ns: int, values: Array) -> BodyState:
    return BodyState(
        stamp_ns=stamp_ns,
        angles_rad=values[0:26],
        gyro_rad_s=values[26:29],
        accel_m_s2=values[29:32],
        torso_roll_pitch_rad=values[32:34],
        fsr_kg=values[34:42],
        battery=float(values[42]),
        temperature_max_c=float(values[43]),
    )


class Shared:
    """The memory, mapped. One process writes it, but for the heartbeat, which is the client's."""

    def __init__(self, fd: int) -> None:
        """Map a file descriptor, which may then be closed. Raises BackendError."""
        size = os.fstat(fd).st_size
        slots, rest = divmod(size - _HEADER_BYTES, _SLOT_BYTES)
        if slots < 2 or rest:
            raise BackendError(f"shared memory of {size} bytes is none of ours")
        self._map = mmap.mmap(fd, size)
        self._head = np.frombuffer(self._map, np.int64, _HEAD_INTS)
        self._text = np.frombuffer(self._map, np.uint8, _STATUS_BYTES, 8 * _HEAD_INTS)
        width = _SLOT_INTS + _SLOT_FLOATS
        table = np.frombuffer(self._map, np.int64, slots * width, _HEADER_BYTES)
        table = table.reshape(slots, width)
        self._ints = table[:, :_SLOT_INTS]
        self._floats = table[:, _SLOT_INTS:].view(np.float64)
        self.slots = int(slots)

    @property
    def count(self) -> int:
        """How many measurements there have been."""
        return int(self._head[_COUNT])

    @property
    def beat_ns(self) -> int:
        """When the client last did anything."""
        return int(self._head[_BEAT])

    def beat(self) -> None:
        """The client is alive."""
        self._head[_BEAT] = time.monotonic_ns()

    def put(self, stamp_ns: int, answered_ns: int, values: Array) -> None:
        """Add a measurement (44,)."""
        number = self.count
        ints = self._ints[number % self.slots]
        ints[_SEQ] += 1
        ints[_STAMP], ints[_ANSWERED], ints[_NUMBER] = stamp_ns, answered_ns, number
        self._floats[number % self.slots] = values
        ints[_SEQ] += 1
        self._head[_COUNT] = number + 1

    def tell(self, status: LolaStatus) -> None:
        """Put the status."""
        data = np.frombuffer(msgspec.msgpack.encode(status), np.uint8)
        self._head[_STATUS_SEQ] += 1
        self._text[: len(data)] = data
        self._head[_STATUS_LENGTH] = len(data)
        self._head[_STATUS_SEQ] += 1

    def status(self) -> LolaStatus:
        """The status. Raises BackendError when it cannot be read."""
        for _ in range(_TRIES):
            before = int(self._head[_STATUS_SEQ])
            data = self._text[: int(self._head[_STATUS_LENGTH])].tobytes()
            if before % 2 == 0 and int(self._head[_STATUS_SEQ]) == before and data:
                return _STATUS.decode(data)
            time.sleep(0)
        raise BackendError("the process of LoLA left its status half written")

    def answer(self, number: int) -> tuple[BodyState, int] | None:
        """A measurement and when it was answered, ns; None if it is gone."""
        found = self._read(number)
        return None if found is None else (_body_state(found[1], found[0]), found[2])

    def newest(self) -> BodyState | None:
        """The newest measurement; None before the first."""
        found = self._read(self.count - 1)
        return None if found is None else _body_state(found[1], found[0])

    def around(self, stamp_ns: int) -> tuple[BodyState, BodyState, float] | None:
        """The measurements before and after a time and how far it is between them, 0 to 1.

        None outside the recorded past.
        """
        low, high = max(0, self.count - self.slots + 1), self.count - 1
        # found: the last one that is not later
        while low < high:
            middle = (low + high + 1) // 2
            stamp = self._stamp(middle)
            if stamp is None or stamp <= stamp_ns:
                low = middle
            else:
                high = middle - 1
        first, second = self._read(low), self._read(low + 1)
        if first is None or first[1] > stamp_ns:
            return None
        before = _body_state(first[1], first[0])
        if first[1] == stamp_ns:
            return before, before, 0.0
        if second is None or second[1] < stamp_ns:
            return None
        share = (stamp_ns - first[1]) / (second[1] - first[1])
        return before, _body_state(second[1], second[0]), share

    def _stamp(self, number: int) -> int | None:
        found = self._read(number)
        return None if found is None else found[1]

    def _read(self, number: int) -> tuple[Array, int, int] | None:
        """Values, stamp and time of the answer of a measurement; None if it is not there."""
        if not 0 <= number < self.count:
            return None
        row = number % self.slots
        for _ in range(_TRIES):
            ints = self._ints[row].copy()
            values = self._floats[row].copy()
            if ints[_SEQ] % 2 == 0 and int(self._ints[row, _SEQ]) == int(ints[_SEQ]):
                if int(ints[_NUMBER]) != number:
                    return None
                return values, int(ints[_STAMP]), int(ints[_ANSWERED])
            time.sleep(0)
        raise BackendError("the process of LoLA left a measurement half written")


def create(slots: int = SLOTS) -> tuple[Shared, int]:
    """New memory with room for so many measurements, and its file descriptor."""
    fd = os.memfd_create("naod-lola")
    os.ftruncate(fd, _HEADER_BYTES + slots * _SLOT_BYTES)
    return Shared(fd), fd
