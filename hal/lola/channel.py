"""What the client wants, as messages on a socket of whole packets, each with a deadline.

A wish that is not renewed is forgotten by the process of LoLA itself, by its own clock.
"""

from __future__ import annotations

import array
import math
import socket

import msgspec

from hal.errors import BackendError
from hal.lola.core import HeadWish, Wanted
from hal.lola.engine import STILL, Motion
from hal.types import HeadAngles, PlanarMotion

PACKET_BYTES = 512
PACKETS_A_TICK = 64


class LookWish(msgspec.Struct, frozen=True, tag="look"):
    """Turn the head."""

    yaw_rad: float
    pitch_rad: float
    speed_rad_s: float
    deadline_ns: int


class VelocityWish(msgspec.Struct, frozen=True, tag="velocity"):
    """Walk at a velocity."""

    x: float
    y: float
    yaw: float
    deadline_ns: int


class StepWish(msgspec.Struct, frozen=True, tag="step"):
    """Walk by a displacement."""

    x: float
    y: float
    yaw: float
    deadline_ns: int


class RenewWish(msgspec.Struct, frozen=True, tag="renew"):
    """Let the present walk go on until then."""

    deadline_ns: int


class StopWish(msgspec.Struct, frozen=True, tag="stop"):
    """End the walk."""


class LeaveWish(msgspec.Struct, frozen=True, tag="leave"):
    """Sit down, let go, end."""


Wish = LookWish | VelocityWish | StepWish | RenewWish | StopWish | LeaveWish
_DECODER = msgspec.msgpack.Decoder(Wish)


def packed(wish: Wish) -> bytes:
    """A packet."""
    return msgspec.msgpack.encode(wish)


def unpacked(data: bytes) -> Wish | None:
    """A wish; None for a packet that is none, or has a number that is not finite."""
    try:
        wish: Wish = _DECODER.decode(data)
    except (msgspec.DecodeError, UnicodeDecodeError):
        return None
    numbers = (getattr(wish, name) for name in wish.__struct_fields__)
    return wish if all(math.isfinite(number) for number in numbers) else None


class Wishes:
    """What is wanted now: the newest of each kind, until its deadline. Holds no clock."""

    def __init__(self) -> None:
        self._look: LookWish | None = None
        self._motion: Motion | None = None
        self._motion_ends_ns = 0
        self._number = 0
        self.leave = False

    def take(self, wish: Wish) -> None:
        """Add a wish."""
        if isinstance(wish, LookWish):
            self._look = wish if wish.speed_rad_s > 0.0 else self._look
        elif isinstance(wish, VelocityWish | StepWish):
            self._walk(wish)
        elif isinstance(wish, RenewWish):
            self._motion_ends_ns = wish.deadline_ns
        elif isinstance(wish, StopWish):
            self._motion = None
        else:
            self.leave = True

    def _walk(self, wish: VelocityWish | StepWish) -> None:
        self._number += 1
        kind = "velocity" if isinstance(wish, VelocityWish) else "step"
        value = PlanarMotion(wish.x, wish.y, wish.yaw)
        still = kind == "velocity" and value == STILL
        self._motion = None if still else Motion(kind, self._number, value)  # type: ignore[arg-type]
        self._motion_ends_ns = wish.deadline_ns

    def still(self) -> None:
        """Nobody is there any more: no motion, the head stays where it is."""
        self._look = self._motion = None

    def wanted(self, now_ns: int, *, alone: bool, stand: bool) -> Wanted:
        """What has not expired."""
        if self._look is not None and now_ns >= self._look.deadline_ns:
            self._look = None
        if self._motion is not None and now_ns >= self._motion_ends_ns:
            self._motion = None
        look = self._look
        head = None
        if look is not None:
            head = HeadWish(HeadAngles(look.yaw_rad, look.pitch_rad), look.speed_rad_s)
        return Wanted(head, self._motion, alone, self.leave, stand)


def send_memory(link: socket.socket, fd: int) -> None:
    """Hand the shared memory over, the first packet of a connection. Raises OSError."""
    rights = array.array("i", [fd])
    link.sendmsg([b"memory"], [(socket.SOL_SOCKET, socket.SCM_RIGHTS, rights)])


def receive_memory(link: socket.socket) -> int:
    """The shared memory's file descriptor.

    Raises ConnectionError when the process ended instead, BackendError when it has none for us.
    """
    try:
        data, fds, _, _ = socket.recv_fds(link, PACKET_BYTES, 1)
    except TimeoutError:
        raise BackendError("the process of LoLA does not answer") from None
    except OSError as error:
        raise ConnectionError(str(error)) from None
    if not data:
        raise ConnectionError("the process of LoLA hung up")
    if len(fds) != 1:
        raise BackendError(data.decode(errors="replace"))
    return int(fds[0])
