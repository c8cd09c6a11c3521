"""The simulated robot's LoLA: one client, a sensor message every 12 ms, actuators in return.

Known (`lola_protocol.yaml`): who listens, sizes, rate, one message answered by one, a client that
does not read is ignored until it goes. Assumed, for nobody has published it: a second client is
hung up on at once; so is one whose bytes are no actuator message; a client that does not answer, or
goes, leaves joints, stiffness and lights as it last set them.
"""

from __future__ import annotations

import contextlib
import socket
import threading
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from hal.lola.layout import SENSOR_BYTES, from_lola
from hal.video.address import forget, listening, parse_address
from sim_backend.speak.lola_body import JointWorld
from sim_backend.speak.lola_sensing import sensor_message
from sim_backend.speak.lola_wire import ActuatorMessage, ActuatorStream, WireError

PERIOD_NS = 12_000_000
READ_BYTES, READS_A_CYCLE = 65536, 8
PRESS_CYCLES = 20
SEND_BUFFER_BYTES = 16 * SENSOR_BYTES


class LolaServer:
    """Serves a world's robot on a Unix socket. `run` is its loop, in whatever thread calls it."""

    def __init__(self, path: str, world: JointWorld, say: Callable[[str], None]) -> None:
        """Listens at once. Raises BackendError when it cannot."""
        self._world, self._say = world, say
        self._listener, self._address = listening(parse_address(f"unix:{path}"))
        self._listener.setblocking(False)
        self._client: socket.socket | None = None
        self._stream = ActuatorStream()
        self._ignored = False
        self._gyro: NDArray[np.float64] = np.zeros(3)
        self._sent = 0
        self._pressed = 0
        self.button = False
        self.last = ActuatorMessage()

    def press(self) -> None:
        """Press the chest button and let it go, as quickly as a finger does."""
        self._pressed = PRESS_CYCLES

    def run(self, stop: threading.Event) -> None:
        """Until told to stop; then hangs up and closes."""
        deadline_ns = time.monotonic_ns()
        try:
            while not stop.is_set():
                self._cycle()
                deadline_ns += PERIOD_NS
                left_ns = deadline_ns - time.monotonic_ns()
                if left_ns < -PERIOD_NS:
                    # cycles that were slept through do not come back
                    deadline_ns = time.monotonic_ns()
                stop.wait(max(left_ns, 0) / 1e9)
        finally:
            self._hang_up("closing")
            self._listener.close()
            forget(self._address)

    def _cycle(self) -> None:
        if self._client is not None:
            self._read(self._client)
        self._accept()
        if self._client is not None and not self._ignored:
            self._write(self._client)

    def _accept(self) -> None:
        with contextlib.suppress(BlockingIOError):
            client, _ = self._listener.accept()
            if self._client is not None:
                self._say("a second client was turned away")
                client.close()
                return
            client.setblocking(False)
            client.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER_BYTES)
            self._client, self._stream, self._ignored = client, ActuatorStream(), False
            self._say("a client has connected")

    def _read(self, client: socket.socket) -> None:
        for _ in range(READS_A_CYCLE):
            if self._client is not client:
                return
            try:
                data = client.recv(READ_BYTES)
            except BlockingIOError:
                return
            except OSError:
                # it went with messages of ours unread; its own have all been read by now
                data = b""
            if not data:
                self._hang_up("the client has gone")
            elif not self._ignored:
                self._take(data)

    def _take(self, data: bytes) -> None:
        try:
            for message in self._stream.feed(data):
                self._obey(message)
        except WireError as error:
            self._hang_up(f"not an actuator message: {error}")

    def _obey(self, message: ActuatorMessage) -> None:
        self.last = message
        position, stiffness = message.Position, message.Stiffness
        self._world.drive(
            None if position is None else from_lola(np.array(position)),
            None if stiffness is None else from_lola(np.array(stiffness)),
        )

    def _write(self, client: socket.socket) -> None:
        now_ns = time.monotonic_ns()
        body = self._world.measured(now_ns, now_ns)
        if body is None:
            # the world's own thread is late
            body = self._world.newest_measured(now_ns)
        if self._sent % 2 == 0:
            self._gyro = body.gyro_rad_s
        self._sent += 1
        button = self.button or self._pressed > 0
        self._pressed = max(0, self._pressed - 1)
        data = sensor_message(body, self._gyro, self._world.stiffness, button)
        try:
            whole = client.send(data) == len(data)
        except BlockingIOError:
            whole = False
        except OSError:
            # it has gone; what it said last is read first
            return
        if not whole:
            self._ignored = True
            self._say("the client does not read and is ignored until it goes")

    def _hang_up(self, why: str) -> None:
        if self._client is not None:
            self._say(f"{why}; the robot {self._world.summary()}")
            self._client.close()
            self._client = None
