"""A camera at the other end of a frame socket (see `hal.video.wire`)."""

from __future__ import annotations

import contextlib
import socket
import threading
import time
from collections import deque

from hal.errors import BackendError
from hal.health import Finding
from hal.protocols import Clock
from hal.types import CameraName
from hal.video.address import Address, connected, parse_address
from hal.video.slot import SlotCamera
from hal.video.wire import (
    HEADER,
    NO_CLOCK,
    REQUEST,
    Header,
    WireError,
    frame_of,
    this_clock,
    unpacked,
)

AGAIN_S = 0.2
SILENCE_S = 3.0
"""A server that sends nothing for so long is called anew."""

CLOCK_WINDOW = 300
AHEAD_MAX_NS = 1_000_000


class SenderClock:
    """How far the sender's clock is behind ours.

    Zero on one machine. Else the least time between sending and arrival among the last pictures:
    too large by the least time a header was under way, which is well below a millisecond by wire.
    """

    def __init__(self) -> None:
        self._ours = this_clock()
        self._gaps: deque[int] = deque(maxlen=CLOCK_WINDOW)

    def offset_ns(self, header: Header, received_ns: int) -> int:
        """To add to the sender's stamps. Raises WireError for a picture sent in the future."""
        if header.clock_id == self._ours != NO_CLOCK:
            if header.sent_ns > received_ns + AHEAD_MAX_NS:
                raise WireError("time", "a picture was sent in the future")
            return 0
        self._gaps.append(received_ns - header.sent_ns)
        return min(self._gaps)


class SocketCamera(SlotCamera):
    """`VideoCamera` that asks a `FrameServer`; connects again whenever it is gone."""

    def __init__(self, address: Address, name: CameraName, size: tuple[int, int], clock: Clock):
        super().__init__(name, size, clock)
        self._address = address
        self._closed = threading.Event()
        self.answered = threading.Event()
        """Set when a server has sent something, be it a picture or not."""
        self._link: socket.socket | None = None
        self._last_stamp_ns = -1
        self._picture_bytes = 2 * size[0] * size[1]
        self.trouble = "nothing has come yet"
        self.refused = 0
        self.connections = 0
        self._thread = threading.Thread(target=self._run, name="frames-ask", daemon=True)

    def start(self) -> None:
        """Begin to ask."""
        self._thread.start()

    def close(self) -> None:
        """Hang up. May be called twice."""
        self._closed.set()
        self.slot.close()
        link = self._link
        if link is not None:
            with contextlib.suppress(OSError):
                link.shutdown(socket.SHUT_RDWR)
        if self._thread.is_alive():
            self._thread.join(timeout=SILENCE_S + 1.0)

    def examine(self) -> list[Finding]:
        """What came by the socket; see `hal.health.Examined`."""
        counts = f"{self.slot.received} pictures, {self.refused} refused"
        if self.trouble:
            return [
                Finding(
                    "camera socket",
                    "warn" if self.slot.received else "fail",
                    f"{self._address}: {self.trouble} ({counts})",
                    "start `naod robot` there, with this camera and size",
                )
            ]
        return [Finding("camera socket", "ok", f"{self._address}: {counts}")]

    def _run(self) -> None:
        while not self._closed.is_set():
            try:
                self._ask(SenderClock())
            except WireError as error:
                self.refused += 1
                self.trouble = str(error)
                self.answered.set()
            except OSError as error:
                self.trouble = error.strerror or str(error)
            self._closed.wait(AGAIN_S)

    def _ask(self, sender: SenderClock) -> None:
        """Ask one server until something goes wrong. Raises OSError, WireError."""
        with connected(self._address, SILENCE_S) as link:
            self._link = link
            self.connections += 1
            while not self._closed.is_set():
                link.sendall(REQUEST)
                header = unpacked(bytes(_exactly(link, HEADER.size)))
                received_ns = time.monotonic_ns()
                self._check(header)
                offset_ns = sender.offset_ns(header, received_ns)
                frame = frame_of(header, _exactly(link, header.length), offset_ns)
                if frame.stamp_ns <= self._last_stamp_ns:
                    raise WireError("time", "a picture is older than the one before")
                self._last_stamp_ns = frame.stamp_ns
                self.trouble = ""
                self.slot.put(frame)
                self.answered.set()

    def _check(self, header: Header) -> None:
        if header.camera != self.name:
            raise WireError("camera", f"it is the {header.camera} camera, not the {self.name} one")
        if (header.width, header.height) != self.size:
            raise WireError(
                "size",
                f"its pictures are {header.width}x{header.height}, "
                f"not {self.size[0]}x{self.size[1]}",
            )


def open_socket(
    text: str, which: CameraName, size: tuple[int, int], clock: Clock, patience_s: float
) -> SocketCamera:
    """Connect and wait for the first picture. Raises BackendError."""
    camera = SocketCamera(parse_address(text), which, size, clock)
    camera.start()
    if patience_s > 0.0 and not (camera.answered.wait(patience_s) and camera.slot.peek()):
        camera.close()
        raise BackendError(f"camera {text}: {camera.trouble}")
    return camera


def _exactly(link: socket.socket, length: int) -> bytearray:
    """So many bytes. Raises OSError when they do not come."""
    data = bytearray(length)
    view, filled = memoryview(data), 0
    while filled < length:
        count = link.recv_into(view[filled:])
        if count == 0:
            raise ConnectionError("the server hung up")
        filled += count
    return data
