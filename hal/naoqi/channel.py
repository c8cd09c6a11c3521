"""A connection that is made anew when it was cut, by the one thread that owns it."""

from __future__ import annotations

import logging
import threading
import time

from hal.errors import HalError
from hal.naoqi.errors import NoAnswerError, NotConnectedError
from hal.naoqi.login import Login
from hal.naoqi.session import Session

log = logging.getLogger(__name__)

RETRY_S = 0.5
UNANSWERED_MAX = 3
"""So many calls in a row without an answer, and the connection is made anew."""


class Channel:
    """Where to connect, and the present connection. `session` may be asked for by any thread."""

    def __init__(self, url: str, login: Login | None, purpose: str) -> None:
        self._url, self._login, self._purpose = url, login, purpose
        self._lock = threading.Lock()
        self._session: Session | None = None
        self._why = "not connected yet"
        self._tried_s = -RETRY_S
        self._unanswered = 0
        self._closed = False

    @property
    def session(self) -> Session:
        """The connection. Raises NotConnectedError while there is none."""
        with self._lock:
            found = self._session
        if found is None or not found.connected:
            raise NotConnectedError(f"no connection to NAOqi: {self._why}")
        return found

    def ensure(self) -> bool:
        """See that there is a connection; true if it is another one than before.

        Raises NotConnectedError, LoginError or BackendError; tries no oftener than RETRY_S.
        """
        with self._lock:
            present = self._session
        if present is not None and present.connected:
            return False
        if present is not None:
            self.drop("it was cut")
        now_s = time.monotonic()
        if self._closed or now_s - self._tried_s < RETRY_S:
            raise NotConnectedError(f"no connection to NAOqi: {self._why}")
        self._tried_s = now_s
        try:
            made = Session(self._url, self._login)
        except HalError as error:
            self._why = str(error)
            raise
        with self._lock:
            self._session, self._unanswered = made, 0
        log.info("connected to %s for the %s", self._url, self._purpose)
        return True

    def note(self, error: HalError) -> None:
        """A call of the owner failed: after too much silence the connection is given up."""
        if isinstance(error, NotConnectedError):
            self.drop(str(error))
        elif isinstance(error, NoAnswerError):
            self._unanswered += 1
            if self._unanswered >= UNANSWERED_MAX:
                self.drop(str(error))
        else:
            self._unanswered = 0

    def answered(self) -> None:
        """A call of the owner was answered."""
        self._unanswered = 0

    def drop(self, why: str) -> None:
        """Give the connection up; `ensure` makes another."""
        with self._lock:
            lost, self._session = self._session, None
        if lost is not None:
            self._why = why
            log.warning("the connection for the %s is lost: %s", self._purpose, why)
            lost.close()

    def close(self) -> None:
        """End it for good."""
        self._closed = True
        with self._lock:
            lost, self._session, self._why = self._session, None, "closed"
        if lost is not None:
            lost.close()
