"""The bus seen from a remote control."""

from __future__ import annotations

import json
import queue
import re
from collections.abc import Callable
from typing import Any

import zenoh

from naod.bus import keys
from naod.bus.session import open_client
from naod.bus.wire import encode
from naod.config import ROBOT_NAME
from naod.errors import InputError, NaodError
from naod.messages import Message, NoArguments

ANSWER_S = 2.5


class CallError(NaodError):
    """A call was answered {ok: false}; the text is the daemon's, on one line."""

    def __init__(self, code: str, message: str) -> None:
        super().__init__(f"{message} ({code})")
        self.code = code


class Client:
    """One robot behind one endpoint. Raises InputError when nobody is there."""

    def __init__(self, endpoint: str, robot: str) -> None:
        self.endpoint = endpoint
        self.robot = robot
        if not re.match(ROBOT_NAME, robot):
            raise InputError(f"robot {robot!r}: use 1 to 32 letters, digits, - or _")
        self._session: Any = open_client(endpoint)
        self._declared: list[Any] = []

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()

    def key(self, name: str) -> str:
        """The whole key of a name."""
        return keys.key(self.robot, name)

    def call(
        self,
        verb: str,
        message: Message | None = None,
        timeout_s: float = ANSWER_S,
        while_waiting: Callable[[], None] = lambda: None,
    ) -> dict[str, Any]:
        """Call a verb; the answer. Raises CallError when refused, InputError when not answered."""
        payload = encode(message or NoArguments())
        replies: queue.SimpleQueue[Any] = queue.SimpleQueue()
        taker = zenoh.handlers.Callback(replies.put, lambda: replies.put(None))
        key = self.key(keys.rpc(verb))
        self._session.get(key, taker, payload=payload, timeout=timeout_s)
        reply = _first(replies, while_waiting)
        while reply is not None and reply.ok is None:
            reply = _first(replies, while_waiting)
        if reply is None:
            raise InputError(f"robot {self.robot!r} does not answer at {self.endpoint}")
        answer = json.loads(reply.ok.payload.to_bytes())
        if answer.get("ok") is True:
            return dict(answer)
        error = answer.get("error", {})
        raise CallError(str(error.get("code")), " ".join(str(error.get("message")).split()))

    def listen(self, name: str, on_bytes: Callable[[bytes], None]) -> None:
        """Hand over whatever is published under a name, in zenoh's thread."""
        subscriber = self._session.declare_subscriber(
            self.key(name), lambda sample: on_bytes(sample.payload.to_bytes())
        )
        self._declared.append(subscriber)

    def publish(self, name: str, message: Message) -> None:
        """Publish at once."""
        self._session.put(
            self.key(name),
            encode(message),
            encoding=zenoh.Encoding.APPLICATION_JSON,
            priority=zenoh.Priority.INTERACTIVE_HIGH,
            express=True,
        )

    def close(self) -> None:
        """Leave the bus."""
        for thing in self._declared:
            thing.undeclare()
        self._declared.clear()
        self._session.close()


def _first(replies: queue.SimpleQueue[Any], while_waiting: Callable[[], None]) -> Any:
    while True:
        try:
            return replies.get(timeout=0.2)
        except queue.Empty:
            while_waiting()
