"""The walk's watchdog: a process of its own, with a connection of its own.

It is told a deadline over its standard input. When the deadline passes, or its input ends because
the daemon has died, it tells the robot to stop until the robot stands. So a daemon that hangs or is
killed cannot leave a robot walking.

Lines in: the address and login as JSON, once; then `arm DEADLINE_NS` (CLOCK_MONOTONIC, which is the
same in all processes of a machine), `disarm`, `end`. Lines out, at least every BEAT_S: `ok` while
NAOqi answers, `cut` while it does not; `fired` when the robot was told to stop.
"""

from __future__ import annotations

import json
import logging
import os
import select
import signal
import sys
import time
from contextlib import suppress

from hal.errors import HalError
from hal.naoqi.channel import Channel
from hal.naoqi.login import Login
from hal.naoqi.session import Call

BEAT_S = 0.2
ANSWER_S = 1.0
AGAIN_S = 0.3
"""How long after a stop the robot is told again if it still moves."""
ORPHAN_S = 30.0
"""How long it tries to stop the robot after its daemon has died."""


class Watchdog:
    """Reads the daemon's lines, watches the time, stops the robot."""

    def __init__(self, channel: Channel) -> None:
        self._channel = channel
        self._deadline_ns: int | None = None
        self._stop: Call | None = None
        self._asked: Call | None = None
        self._buffer = b""
        self.ended = False
        self.orphaned_s: float | None = None

    @property
    def is_needed(self) -> bool:
        """False when it may go: told so, or its daemon is gone and the robot stands."""
        if self.ended:
            return False
        if self.orphaned_s is None:
            return True
        return self._deadline_ns is not None and time.monotonic() - self.orphaned_s < ORPHAN_S

    def turn(self) -> None:
        """Wait for a line or for the deadline, then do what is due."""
        self._listen()
        try:
            self._channel.ensure()
            self._beat()
            self._say("ok")
        except HalError as error:
            self._channel.note(error)
            self._asked = self._stop = None
            self._say("cut")

    def abandoned(self) -> None:
        """The daemon is gone: whatever was allowed is so no longer."""
        if self.orphaned_s is None:
            self.orphaned_s = time.monotonic()
        if self._deadline_ns is not None:
            self._deadline_ns = 0

    def _listen(self) -> None:
        wait_s = BEAT_S
        if self._deadline_ns is not None:
            left_s = (self._deadline_ns - time.monotonic_ns()) / 1e9
            wait_s = min(wait_s, max(left_s, 0.01))
        if self.orphaned_s is not None:
            select.select([], [], [], min(wait_s, 0.05))
            return
        if not select.select([0], [], [], wait_s)[0]:
            return
        data = os.read(0, 65536)
        if not data:
            self.abandoned()
        *lines, self._buffer = (self._buffer + data).split(b"\n")
        for line in lines:
            self._take(line.decode().split())

    def _take(self, words: list[str]) -> None:
        if words[:1] == ["arm"]:
            self._deadline_ns = int(words[1])
        elif words == ["disarm"]:
            self._deadline_ns = None
        elif words == ["end"]:
            self.ended = True

    def _beat(self) -> None:
        """Stop the robot if that is due; ask whether it moves, which shows that it answers."""
        if self._deadline_ns is not None and time.monotonic_ns() >= self._deadline_ns:
            self._make_it_stand()
        else:
            self._stop = None
        if self._asked is None or self._asked.done:
            if self._asked is not None:
                self._asked.result(0.0)
            self._asked = self._channel.session.post("ALMotion", "moveIsActive")
        elif self._asked.age_s > ANSWER_S:
            self._asked.result(0.0)

    def _make_it_stand(self) -> None:
        if self._stop is None:
            self._fire()
        elif self._stop.age_s > (AGAIN_S if self._stop.done else ANSWER_S):
            if self._stop.done and self._stands():
                self._deadline_ns = self._stop = None
            else:
                self._fire()

    def _fire(self) -> None:
        self._stop = self._channel.session.post("ALMotion", "stopMove")
        self._say("fired")

    def _stands(self) -> bool:
        return not self._channel.session.call("ALMotion", "moveIsActive", timeout_s=ANSWER_S)

    def _say(self, word: str) -> None:
        with suppress(OSError):
            os.write(1, f"{word}\n".encode())


def main() -> int:
    """Run until told to end, or until the daemon is gone and the robot stands."""
    logging.basicConfig(level="WARNING", format="watchdog: %(levelname)s: %(message)s")
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)
    line = _first_line()
    if not line:
        return 0
    told = json.loads(line)
    login = Login(told["user"], told["password"]) if told["password"] else None
    channel = Channel(told["url"], login, "watchdog")
    dog = Watchdog(channel)
    signal.signal(signal.SIGTERM, lambda _number, _frame: dog.abandoned())
    while dog.is_needed:
        dog.turn()
    channel.close()
    return 0


def _first_line() -> bytes:
    line = bytearray()
    while not line.endswith(b"\n"):
        data = os.read(0, 1)
        if not data:
            return b""
        line += data
    return bytes(line)


if __name__ == "__main__":
    sys.exit(main())
