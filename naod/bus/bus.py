"""Typed publishing, subscribing and answering under one robot's keys."""

from __future__ import annotations

import json
import logging
import threading
from collections.abc import Callable
from typing import Any, TypeVar

import zenoh

from naod.bus import keys
from naod.bus.session import open_server
from naod.bus.wire import CONTROL_BYTES_MAX, RefusedError, decode, encode, failure
from naod.config import BusConfig
from naod.messages import Message

T = TypeVar("T", bound=Message)
log = logging.getLogger(__name__)

JSON = zenoh.Encoding.APPLICATION_JSON
COMMANDS = (keys.WALK_COMMAND, keys.HEAD_COMMAND)


class Answer:
    """The one answer to one call; may be given later, from any thread."""

    def __init__(self, query: Any, key: str) -> None:
        self._query: Any = query
        self._key = key
        self._lock = threading.Lock()

    def done(self, message: Message) -> None:
        """Answer with a message that has `ok: true`."""
        self._send(encode(message))

    def ok(self, **fields: object) -> None:
        """Answer {ok: true, ...}."""
        self._send(json.dumps({"ok": True, **fields}, allow_nan=False).encode())

    def error(self, code: str, message: str) -> None:
        """Answer {ok: false, error: {code, message}}."""
        self._send(failure(code, message))

    def _send(self, payload: bytes) -> None:
        with self._lock:
            query, self._query = self._query, None
        if query is None:
            return
        try:
            with query:
                query.reply(self._key, payload, encoding=JSON)
        except zenoh.ZError as error:
            # whoever asked has gone; there is nobody left to tell
            log.debug("answer on %s not sent: %s", self._key, error)


class Bus:
    """A zenoh session seen from one robot. Callbacks run in zenoh's own threads."""

    def __init__(self, session: zenoh.Session, robot: str) -> None:
        self.session: Any = session
        self.robot = robot
        self._lock = threading.Lock()
        self._publishers: dict[str, Any] = {}
        self._declared: list[Any] = []

    @classmethod
    def open(cls, config: BusConfig, robot: str) -> Bus:
        """Open the daemon's side. Raises InputError that names the endpoint."""
        return cls(open_server(config), robot)

    def key(self, name: str) -> str:
        """The whole key of a name."""
        return keys.key(self.robot, name)

    def publish(self, name: str, message: Message) -> None:
        """Publish; whoever cannot keep up misses it."""
        self._publisher(name).put(encode(message))

    def subscribe(
        self,
        name: str,
        kind: type[T],
        on_message: Callable[[T], None],
        on_refused: Callable[[str], None],
    ) -> None:
        """Hand over every message that is one; say why of every other (S7)."""

        def receive(sample: Any) -> None:
            try:
                message = _taken(sample, kind)
            except RefusedError as error:
                on_refused(f"{name}: {error}")
                return
            on_message(message)

        _check_thread()
        self._declared.append(self.session.declare_subscriber(self.key(name), receive))

    def answer(
        self,
        verb: str,
        kind: type[T],
        handler: Callable[[T, Answer], None],
        on_refused: Callable[[str], None],
    ) -> None:
        """Answer a verb; every call gets an answer, also one that cannot be read."""
        name = keys.rpc(verb)
        whole = self.key(name)

        def receive(query: Any) -> None:
            answer = Answer(query, whole)
            try:
                call = _asked(query, kind)
            except RefusedError as error:
                on_refused(f"{name}: {error}")
                answer.error("bad_request", str(error))
                return
            try:
                handler(call, answer)
            except Exception:
                log.exception("rpc %s failed", verb)
                answer.error("internal", "the daemon could not do it; see its log")

        _check_thread()
        self._declared.append(self.session.declare_queryable(whole, receive))

    def announce(self) -> None:
        """Declare the liveliness token: the robot is there."""
        token = self.session.liveliness().declare_token(self.key(keys.ALIVE))
        self._declared.append(token)

    def close(self) -> None:
        """Leave the bus; callbacks no longer come."""
        for thing in reversed(self._declared):
            thing.undeclare()
        self._declared.clear()
        self.session.close()

    def _publisher(self, name: str) -> Any:
        with self._lock:
            publisher = self._publishers.get(name)
            if publisher is None:
                urgent = name in COMMANDS
                priority = zenoh.Priority.INTERACTIVE_HIGH if urgent else zenoh.Priority.DATA
                publisher = self.session.declare_publisher(
                    self.key(name),
                    encoding=JSON,
                    congestion_control=zenoh.CongestionControl.DROP,
                    priority=priority,
                    express=True,
                )
                self._publishers[name] = publisher
            return publisher


def _check_thread() -> None:
    """zenoh's callback threads inherit the daemon flag of the thread that declares them.

    A daemon thread inside zenoh while the interpreter closes down aborts the process.
    """
    if threading.current_thread().daemon:
        raise RuntimeError("declare subscribers and queryables from a thread that is joined")


def _taken(sample: Any, kind: type[T]) -> T:
    if sample.kind != zenoh.SampleKind.PUT:
        raise RefusedError("unknown: not a put")
    return _decoded(sample.payload, kind)


def _asked(query: Any, kind: type[T]) -> T:
    # a call without a body is a call without arguments
    return decode(b"{}", kind) if query.payload is None else _decoded(query.payload, kind)


def _decoded(payload: Any, kind: type[T]) -> T:
    size = len(payload)
    if size > CONTROL_BYTES_MAX:
        raise RefusedError(f"oversized: {size} bytes, at most {CONTROL_BYTES_MAX}")
    return decode(payload.to_bytes(), kind)
