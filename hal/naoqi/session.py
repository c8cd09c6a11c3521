"""One connection to NAOqi. Every call has a time in which it must be answered.

The only room that touches `qi`: no object of it leaves, its errors become ours. A `qi.Session`
works without a `qi.Application`, whose signal handling would be in the way of the daemon's own.
"""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable
from typing import Any
from urllib.parse import urlsplit

from hal.errors import BackendError, HalError
from hal.naoqi.errors import (
    CallRefusedError,
    LoginError,
    NoAnswerError,
    NotConnectedError,
    ServiceMissingError,
)
from hal.naoqi.login import Login
from hal.naoqi.plain import plain

CONNECT_S = 5.0
CALL_S = 1.0

_CUT = ("session closed", "not connected", "disconnected", "connection reset")
_LOST = "the connection is lost: "


def load_qi() -> Any:
    """The `qi` package, quiet. Raises BackendError when it is not installed."""
    try:
        import qi
    except ImportError as error:
        raise BackendError(
            f"the NAOqi backend needs the package qi (pip install 'naod[naoqi]'): {error}"
        ) from None
    # what it would print is told by our own errors
    qi.logging.setLevel(qi.logging.FATAL)
    return qi


class _Authenticator:
    def __init__(self, login: Login) -> None:
        self._login = login

    def initialAuthData(self) -> dict[str, str]:
        return {"user": self._login.user, "token": self._login.password}

    def newAuthenticator(self) -> _Authenticator:
        return self


class Call:
    """A call under way."""

    def __init__(self, future: Any, name: str) -> None:
        self._future = future
        self._name = name
        self.since_s = time.monotonic()

    @property
    def done(self) -> bool:
        """Whether there is an answer, good or bad."""
        return bool(self._future.isFinished())

    @property
    def age_s(self) -> float:
        """Time since it was sent."""
        return time.monotonic() - self.since_s

    def wait(self, timeout_s: float) -> bool:
        """Wait for the answer; whether it came."""
        if timeout_s > 0.0 and not self.done:
            self._future.wait(max(1, round(timeout_s * 1e3)))
        return self.done

    def result(self, timeout_s: float = CALL_S) -> Any:
        """The answer. Raises NoAnswerError, NotConnectedError, CallRefusedError, ..."""
        if not self.wait(timeout_s):
            raise NoAnswerError(f"{self._name}: no answer within {timeout_s:g} s")
        try:
            return self._future.value(0)
        except RuntimeError as error:
            raise told_by(error, self._name) from None


class Session:
    """A connection, opened by the constructor. Its calls may come from any thread.

    Raises NotConnectedError, LoginError or BackendError when it cannot be opened.
    """

    def __init__(self, url: str, login: Login | None, timeout_s: float = CONNECT_S) -> None:
        qi = load_qi()
        if not _listens(url):
            # qi has crashed where sessions that could not connect were made one after another
            raise NotConnectedError(f"NAOqi at {url} is not reachable: nobody listens there")
        self._services: dict[str, Any] = {}
        self._lock = threading.Lock()
        self._session = qi.Session()
        if login is not None:
            self._session.setClientAuthenticatorFactory(_Authenticator(login))
        call = Call(self._session.connect(url, _async=True), f"connecting to {url}")
        try:
            call.result(timeout_s)
        except HalError as error:
            self._session.close()
            raise _unconnected(error, url, login) from None

    @property
    def connected(self) -> bool:
        """Whether the connection stands, as far as this side knows."""
        return bool(self._session.isConnected())

    def call(self, service: str, method: str, *args: object, timeout_s: float = CALL_S) -> Any:
        """Call and wait for the answer. Raises what `post` and `Call.result` raise."""
        return self.post(service, method, *args).result(timeout_s)

    def post(self, service: str, method: str, *args: object) -> Call:
        """Call without waiting. Raises NotConnectedError, ServiceMissingError or TypeError."""
        name = f"{service}.{method}"
        function = self._method(service, method)
        values = [plain(value) for value in args]
        try:
            return Call(function(*values, _async=True), name)
        except RuntimeError as error:
            raise told_by(error, name) from None

    def has(self, service: str, method: str | None = None) -> bool:
        """Whether the robot offers a service, and a method of it. Raises NotConnectedError."""
        try:
            proxy = self._proxy(service)
        except ServiceMissingError:
            return False
        return method is None or hasattr(proxy, method)

    def close(self) -> None:
        """End it. May be called twice."""
        with self._lock:
            self._services.clear()
        self._session.close()

    def _method(self, service: str, method: str) -> Callable[..., Any]:
        proxy = self._proxy(service)
        function = getattr(proxy, method, None)
        if function is None:
            raise ServiceMissingError(f"this robot's {service} has no method {method}")
        found: Callable[..., Any] = function
        return found

    def _proxy(self, service: str) -> Any:
        with self._lock:
            known = self._services.get(service)
        if known is not None:
            return known
        call = Call(self._session.service(service, _async=True), f"service {service}")
        found = call.result()
        with self._lock:
            self._services[service] = found
        return found


def told_by(error: RuntimeError, name: str) -> HalError:
    """Our error for one of `qi`; its text is the first line of the other's."""
    lines = str(error).strip().splitlines()
    text = lines[0].removeprefix("RuntimeError: ") if lines else "no reason given"
    lower = text.lower()
    if "cannot find service" in lower:
        return ServiceMissingError(f"{name}: this robot does not offer it")
    if lower.startswith("arguments types did not match"):
        return ServiceMissingError(f"{name}: this robot takes other arguments")
    if any(words in lower for words in _CUT) or lower.startswith("connect error"):
        return NotConnectedError(f"{name}: {_LOST}{text}")
    return CallRefusedError(f"{name}: {text}")


def _unconnected(error: HalError, url: str, login: Login | None) -> HalError:
    if isinstance(error, NoAnswerError):
        return NotConnectedError(f"NAOqi at {url} does not answer")
    text = str(error).removeprefix(f"connecting to {url}: ").removeprefix(_LOST)
    # a login that fails shows as nothing but a connection that was closed
    if text == "disconnected" and _listens(url):
        who = "without a password" if login is None else f"as {login.user!r} with this password"
        return LoginError(f"NAOqi at {url} closes the connection: it does not let us in {who}")
    return NotConnectedError(f"NAOqi at {url} is not reachable: {text}")


def _listens(url: str) -> bool:
    try:
        parts = urlsplit(url)
        with socket.create_connection((parts.hostname or "", parts.port or 0), timeout=1.0):
            return True
    except (OSError, ValueError):
        return False
