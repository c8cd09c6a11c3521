"""The frame socket's server: hands a camera's pictures to whoever asks (see `hal.video.wire`).

A picture is taken from the camera only while a client waits for one.
"""

from __future__ import annotations

import contextlib
import socket
import threading
import time
from dataclasses import dataclass, field

import numpy as np

from hal.errors import CameraTimeoutError
from hal.protocols import Camera
from hal.types import Frame
from hal.video.address import forget, listening, parse_address
from hal.video.wire import REQUEST, packed, this_clock

CLIENTS_MAX = 8
SEND_TIMEOUT_S = 5.0
CAMERA_TIMEOUT_S = 0.1


@dataclass(eq=False)
class _Client:
    """`had`: the frame it was sent last."""

    link: socket.socket
    had: Frame | None = None
    waits: bool = False
    thread: threading.Thread | None = field(default=None, repr=False)


class FrameServer:
    """Serves one camera at one address. The frames' stamps are of this machine's CLOCK_MONOTONIC.

    `address`: tcp://HOST:PORT (port 0 for a free one) or unix:PATH. Listens at once, serves from
    `start` on. Raises BackendError when it cannot listen.
    """

    def __init__(self, address: str, camera: Camera) -> None:
        self._camera = camera
        self._clock_id = this_clock()
        self._listener, self._address = listening(parse_address(address))
        self._changed = threading.Condition()
        self._clients: set[_Client] = set()
        self._newest: Frame | None = None
        self._closed = False
        self._threads = [
            threading.Thread(target=self._accept, name="frames-accept", daemon=True),
            threading.Thread(target=self._take, name="frames-take", daemon=True),
        ]

    @property
    def address(self) -> str:
        """Where it listens, for `[camera] device`."""
        return str(self._address)

    def start(self) -> None:
        """Begin to answer."""
        for thread in self._threads:
            thread.start()

    def close(self) -> None:
        """Hang up and stop listening. May be called twice."""
        with self._changed:
            if self._closed:
                return
            self._closed = True
            clients = list(self._clients)
            self._changed.notify_all()
        # shutting down wakes a thread that waits in accept or recv; closing alone does not
        for link in [self._listener, *(client.link for client in clients)]:
            with contextlib.suppress(OSError):
                link.shutdown(socket.SHUT_RDWR)
        self._listener.close()
        forget(self._address)
        for thread in [*self._threads, *(client.thread for client in clients)]:
            if thread is not None and thread.is_alive():
                thread.join(timeout=2.0)

    def _accept(self) -> None:
        while True:
            try:
                link, _ = self._listener.accept()
            except OSError:
                return
            client = _Client(link)
            with self._changed:
                if self._closed or len(self._clients) >= CLIENTS_MAX:
                    link.close()
                    continue
                self._clients.add(client)
            client.thread = threading.Thread(
                target=self._serve, args=(client,), name="frames-client", daemon=True
            )
            client.thread.start()

    def _take(self) -> None:
        """Read the camera while somebody waits for what it sees."""
        while True:
            with self._changed:
                self._changed.wait_for(self._is_wanted)
                if self._closed:
                    return
            try:
                frame = self._camera.unseen(CAMERA_TIMEOUT_S)
            except CameraTimeoutError:
                continue
            with self._changed:
                self._newest = frame
                self._changed.notify_all()

    def _is_wanted(self) -> bool:
        return self._closed or any(
            client.waits and client.had is self._newest for client in self._clients
        )

    def _serve(self, client: _Client) -> None:
        link = client.link
        try:
            if link.family != socket.AF_UNIX:
                link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            while link.recv(1) == REQUEST:
                frame = self._frame_for(client)
                if frame is None:
                    return
                link.settimeout(SEND_TIMEOUT_S)
                link.sendall(packed(frame, time.monotonic_ns(), self._clock_id))
                link.sendall(np.ascontiguousarray(frame.yuyv).data)
                link.settimeout(None)
        except OSError:
            # it hung up, or reads so slowly that it is as good as gone
            return
        finally:
            with self._changed:
                self._clients.discard(client)
                self._changed.notify_all()
            link.close()

    def _frame_for(self, client: _Client) -> Frame | None:
        """The next frame that it has not had; None when all is over."""
        with self._changed:
            client.waits = True
            self._changed.notify_all()
            self._changed.wait_for(
                lambda: (
                    self._closed or (self._newest is not None and self._newest is not client.had)
                )
            )
            client.waits = False
            client.had = self._newest
            return None if self._closed else self._newest
