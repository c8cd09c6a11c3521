"""The connection to LoLA: bytes in and out, never blocking longer than it is told.

There is no framing: a sensor message is the next 896 bytes. LoLA answers nothing before it has been
read, so nothing is sent that is not the answer to a message (`lola_protocol.yaml`, client_rules).
"""

from __future__ import annotations

import select
import socket

from hal.errors import HalError
from hal.lola.layout import SENSOR_BYTES

READ_BYTES = 64 * SENSOR_BYTES


class LinkError(HalError):
    """LoLA is not there, or has hung up; the text says which."""


class Link:
    """One connection, which is over for good when anything goes wrong with it."""

    def __init__(self, connected: socket.socket) -> None:
        self._socket = connected
        self._socket.setblocking(False)
        self._poll = select.poll()
        self._poll.register(connected, select.POLLIN)
        self._received = bytearray()
        self._unsent = b""
        self.skipped = 0
        self.passed_over = 0

    def receive(self, timeout_s: float) -> bytes | None:
        """The newest whole message; None if none comes in time. Raises LinkError.

        Older ones that have piled up are passed over: what they said is no longer so.
        """
        if not self._poll.poll(timeout_s * 1000.0):
            return None
        try:
            data = self._socket.recv(READ_BYTES)
        except (BlockingIOError, InterruptedError):
            return None
        except OSError as error:
            raise LinkError(f"LoLA's connection broke: {error.strerror}") from None
        if not data:
            raise LinkError("LoLA hung up")
        self._received += data
        whole = len(self._received) // SENSOR_BYTES
        if whole == 0:
            return None
        message = bytes(self._received[(whole - 1) * SENSOR_BYTES : whole * SENSOR_BYTES])
        del self._received[: whole * SENSOR_BYTES]
        self.passed_over += whole - 1
        return message

    def send(self, message: bytes) -> bool:
        """Send a whole message, or none of it if LoLA does not read. Raises LinkError."""
        try:
            if self._unsent:
                self._unsent = self._unsent[self._socket.send(self._unsent) :]
            if self._unsent:
                self.skipped += 1
                return False
            self._unsent = message[self._socket.send(message) :]
        except (BlockingIOError, InterruptedError):
            self.skipped += 1
            return False
        except OSError as error:
            raise LinkError(f"LoLA's connection broke: {error.strerror}") from None
        return True

    def close(self) -> None:
        """Hang up. May be called twice."""
        self._socket.close()


def connect(path: str, timeout_s: float) -> Link:
    """Connect to LoLA. Raises LinkError."""
    link = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    link.settimeout(timeout_s)
    try:
        link.connect(path)
    except OSError as error:
        link.close()
        raise LinkError(f"{path}: {error.strerror or error}") from None
    return Link(link)
