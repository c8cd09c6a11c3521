"""The daemon's line to the process of LoLA: wishes out, what is measured in."""

from __future__ import annotations

import select
import socket
import threading
import time

from hal.errors import BackendError, MotionRefusedError
from hal.lola.channel import Wish, packed
from hal.lola.shared import LolaStatus, Shared

POLL_S = 0.002


class Line:
    """Safe to call from any thread. Every call tells the process that we are alive."""

    def __init__(self, link: socket.socket, shared: Shared) -> None:
        self._link, self._shared = link, shared
        self._lock = threading.Lock()
        self._closed = False

    @property
    def shared(self) -> Shared:
        """What is measured. Raises BackendError when the process has gone."""
        self._check()
        self._shared.beat()
        return self._shared

    def status(self) -> LolaStatus:
        """What the process is at. Raises BackendError when it has gone."""
        return self.shared.status()

    def send(self, wish: Wish) -> None:
        """Say what is wanted. Raises MotionRefusedError when it cannot be said."""
        try:
            self._check()
            self._shared.beat()
            self._link.send(packed(wish))
        except BlockingIOError:
            raise MotionRefusedError("the process of LoLA does not listen") from None
        except (OSError, BackendError) as error:
            raise MotionRefusedError(f"the process of LoLA has gone: {error}") from None

    def first_status(self, timeout_s: float) -> LolaStatus:
        """The status once LoLA has answered, or as it is when the time is over. BackendError."""
        limit = time.monotonic() + timeout_s
        status = self.status()
        while not status.connected and time.monotonic() < limit:
            time.sleep(POLL_S)
            status = self.status()
        return status

    def close(self, patience_s: float) -> bool:
        """Hang up once the process has ended, or the patience has; whether it has."""
        with self._lock:
            if self._closed:
                return True
            self._closed = True
        limit = time.monotonic() + patience_s
        try:
            while (left := limit - time.monotonic()) > 0.0:
                if select.select([self._link], [], [], left)[0] and not self._link.recv(16):
                    return True
        except OSError:
            return True
        finally:
            self._link.close()
        return False

    def _check(self) -> None:
        """Raises BackendError when the process has hung up: it never sends anything."""
        if self._closed:
            raise BackendError("the robot has been closed")
        try:
            data = self._link.recv(16)
        except (BlockingIOError, InterruptedError):
            return
        except OSError as error:
            raise BackendError(f"the process of LoLA has gone: {error.strerror}") from None
        raise BackendError("the process of LoLA has gone" if not data else "not a process of ours")
