"""Who the process of LoLA works for: one daemon at a time, and the next one when it is gone.

The process outlives a daemon that dies, and its joints stay as they are: a daemon that is started
anew finds it by LoLA's path and takes it over, without a moment in which nobody speaks to LoLA.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import select
import socket
import struct

from hal.errors import BackendError
from hal.lola.channel import PACKET_BYTES, PACKETS_A_TICK, Wishes, send_memory, unpacked
from hal.lola.shared import Shared

SILENT_NS = 500_000_000
"""A client that has not touched anything for so long hangs: nothing is wanted any more."""

TAKEN_OVER_NS = 3_000_000_000
"""One that has been hanging for so long loses the robot to another that asks for it."""

BUSY = b"another daemon has this robot"
_CREDENTIALS = struct.Struct("3i")


def meeting_place(path: str) -> bytes:
    """The abstract address where the process for a LoLA socket is found; gone when it ends."""
    digest = hashlib.sha256(os.fsencode(os.path.realpath(path))).hexdigest()[:32]
    return b"\0naod-lola-" + digest.encode()


def is_served(path: str) -> bool:
    """Whether a process of ours has this LoLA; it is not disturbed by being asked."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as probe:
        try:
            probe.bind(meeting_place(path))
        except OSError:
            return True
    return False


def peer_uid(link: socket.socket) -> int:
    """The user at the other end of a Unix socket."""
    raw = link.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, _CREDENTIALS.size)
    return int(_CREDENTIALS.unpack(raw)[1])


class ClientDesk:
    """Listens for clients and takes in what the present one wants."""

    def __init__(self, path: str, shared: Shared, fd: int) -> None:
        """Raises BackendError if there is a process for this path already."""
        self._shared, self._fd = shared, fd
        self._listener = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._listener.setblocking(False)
        try:
            self._listener.bind(meeting_place(path))
        except OSError:
            self._listener.close()
            raise BackendError(f"{path}: another process of ours has it") from None
        self._listener.listen(4)
        self._client: socket.socket | None = None
        self.gone_ns: int | None = None
        self.malformed = 0

    def serve(self, wishes: Wishes, now_ns: int) -> None:
        """Take in what there is, at once. `gone_ns` is since when nobody is there; else None."""
        if self._client is not None:
            self._read(self._client, wishes)
        if not wishes.leave:
            # else whoever calls waits, and sees us hang up when we end
            self._accept(now_ns)
        hangs = now_ns - self._shared.beat_ns > SILENT_NS
        if self._client is not None and not hangs:
            self.gone_ns = None
        elif self.gone_ns is None:
            self.gone_ns = now_ns
        if self.gone_ns is not None:
            wishes.still()

    def wait(self, timeout_s: float) -> None:
        """Until somebody comes, or the time is over."""
        select.select(
            [self._listener, *([self._client] if self._client else [])], [], [], timeout_s
        )

    def close(self) -> None:
        """Hang up."""
        self._drop()
        self._listener.close()

    def _read(self, client: socket.socket, wishes: Wishes) -> None:
        for _ in range(PACKETS_A_TICK):
            try:
                data = client.recv(PACKET_BYTES)
            except (BlockingIOError, InterruptedError):
                return
            except OSError:
                data = b""
            if not data:
                self._drop()
                return
            wish = unpacked(data)
            if wish is None:
                self.malformed += 1
            else:
                wishes.take(wish)

    def _accept(self, now_ns: int) -> None:
        try:
            link, _ = self._listener.accept()
        except OSError:
            return
        link.setblocking(False)
        lives = self._client is not None and now_ns - self._shared.beat_ns < TAKEN_OVER_NS
        if lives or peer_uid(link) != os.getuid():
            with contextlib.suppress(OSError):
                link.send(BUSY)
            link.close()
            return
        self._drop()
        try:
            send_memory(link, self._fd)
        except OSError:
            link.close()
            return
        self._shared.beat()
        self._client = link

    def _drop(self) -> None:
        if self._client is not None:
            self._client.close()
            self._client = None
