"""The process that serves LoLA's socket: `python -m hal.lola.process TOLD`.

It holds no kernels, no pictures and no bus, so nothing of that can delay an answer. It ends when
its client asks for it, is gone for too long, or on SIGTERM: each time it sits the robot down first.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import time
from types import FrameType

import msgspec

from hal.errors import BackendError
from hal.lola.channel import Wishes
from hal.lola.client import ClientDesk
from hal.lola.core import Core, Wanted
from hal.lola.link import Link, LinkError, connect
from hal.lola.modes import Mode
from hal.lola.priority import be_first
from hal.lola.reporting import status_of
from hal.lola.sensors import MessageError
from hal.lola.session import Counts, Session
from hal.lola.shared import Shared, create
from hal.lola.standing import StandingEngine, StandingState
from hal.lola.told import Told

WAIT_S = 0.1
RETRY_NS = 500_000_000
STALLED_NS = 2_000_000_000
"""LoLA has a message every 12 ms; one that has had none for so long is called anew."""

SILENT_NS = 200_000_000
LEAVE_MAX_NS = 15_000_000_000
CONNECT_S = 0.5


_SAID: dict[Mode | None, str] = {
    "hold": "holding the pose the robot is in; a press of the chest button sits or stands it",
    "stand": "standing up",
    "rest": "sitting down, then letting go",
    "fallen": "the robot has fallen",
}


class Server:
    """The process's one loop and what it remembers from connection to connection."""

    def __init__(self, told: Told, shared: Shared, fd: int, real_time: bool) -> None:
        self._told = told
        self._shared = shared
        self._real_time = real_time
        self._core: Core[StandingState] = Core(
            StandingEngine(), limp_when_fallen=told.when_fallen == "limp"
        )
        self._wishes = Wishes()
        self._desk = ClientDesk(told.socket, shared, fd)
        self._counts = Counts()
        self._session: Session | None = None
        self._link: Link | None = None
        self._resting = False
        self._retry_ns = 0
        self._heard_ns = 0
        self._leave_ns: int | None = None
        self._trouble = ""
        self._unreachable = False

    def leave(self) -> None:
        """Sit down and end."""
        self._wishes.leave = True

    def run(self) -> None:
        """Until the robot has been left."""
        shared, desk = self._shared, self._desk
        shared.beat()
        desk.gone_ns = time.monotonic_ns()
        self._tell(time.monotonic_ns())
        try:
            while not self._is_over(time.monotonic_ns()):
                if self._link is None:
                    self._call(time.monotonic_ns())
                else:
                    self._answer()
        finally:
            self._hang_up()
            desk.close()

    def _answer(self) -> None:
        """Wait for LoLA's next message and answer it."""
        assert self._link is not None
        assert self._session is not None
        try:
            data = self._link.receive(WAIT_S)
            now_ns = time.monotonic_ns()
            self._desk.serve(self._wishes, now_ns)
            if data is not None:
                self._heard_ns = now_ns
                before = self._session.mode
                self._session.tick(data, self._wanted(now_ns))
                if self._session.mode != before:
                    self._say(_SAID[self._session.mode])
                self._trouble = ""
            elif now_ns - self._heard_ns > STALLED_NS:
                raise LinkError("LoLA went silent")
        except MessageError as error:
            self._counts.bad += 1
            self._session.repeat()
            self._break(str(error))
        except LinkError as error:
            self._break(str(error))
        self._tell(time.monotonic_ns())

    def _wanted(self, now_ns: int) -> Wanted:
        alone = self._desk.gone_ns is not None
        stand = self._told.stand_up == "start" and not alone
        return self._wishes.wanted(now_ns, alone=alone, stand=stand)

    def _call(self, now_ns: int) -> None:
        """Connect to LoLA, now and then."""
        self._desk.serve(self._wishes, now_ns)
        if now_ns < self._retry_ns:
            self._desk.wait(min(WAIT_S, (self._retry_ns - now_ns) / 1e9))
            return
        self._retry_ns = now_ns + RETRY_NS
        try:
            self._link = connect(self._told.socket, CONNECT_S)
        except LinkError as error:
            self._unreachable = True
            self._complain(str(error))
        else:
            self._unreachable = False
            self._counts.connections += 1
            self._heard_ns = time.monotonic_ns()
            self._session = Session(
                self._link, self._core, self._shared, self._counts, self._resting
            )
        self._tell(time.monotonic_ns())

    def _break(self, why: str) -> None:
        """The connection cannot go on: targets will start from the measured pose again."""
        self._complain(why)
        self._hang_up()
        self._retry_ns = time.monotonic_ns() + RETRY_NS

    def _complain(self, why: str) -> None:
        if why != self._trouble:
            self._say(why)
        self._trouble = why

    def _say(self, text: str) -> None:
        if not self._told.quiet:
            say(text)

    def _hang_up(self) -> None:
        if self._session is not None:
            self._resting = self._session.resting
        self._session = None
        if self._link is not None:
            self._link.close()
            self._link = None

    def _is_over(self, now_ns: int) -> bool:
        gone_ns = self._desk.gone_ns
        if gone_ns is not None and now_ns - gone_ns > self._told.sit_after_s * 1e9:
            self._wishes.leave = True
        if not self._wishes.leave:
            return False
        if self._leave_ns is None:
            self._leave_ns = now_ns
            self._say("leaving")
        if self._session is not None and self._session.done:
            self._say("left: the last message was safe")
            return True
        # a LoLA that is not there cannot be told anything; a robot that cannot sit stays stiff
        nobody = self._link is None and self._unreachable
        return nobody or now_ns - self._leave_ns > LEAVE_MAX_NS

    def _tell(self, now_ns: int) -> None:
        """Publish what we are at."""
        self._shared.tell(
            status_of(
                self._session,
                self._core,
                self._counts,
                now_ns,
                silent=now_ns - self._heard_ns > SILENT_NS,
                real_time=self._real_time,
                trouble=self._trouble,
            )
        )


def say(text: str) -> None:
    """A line for whoever reads the daemon's log; it may be gone, and that is no reason to fall."""
    with contextlib.suppress(OSError):
        os.write(2, f"naod: LoLA: {text}\n".encode())


def main() -> int:
    """Exit status 0 when the robot was left, 2 when it could not be had."""
    told = msgspec.json.decode(sys.argv[1], type=Told)
    shared, fd = create(told.slots)
    try:
        server = Server(told, shared, fd, be_first() if told.real_time else False)
    except BackendError as error:
        say(str(error))
        return 2

    def leave(_number: int, _frame: FrameType | None) -> None:
        server.leave()

    signal.signal(signal.SIGTERM, leave)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # whoever started us waits for this
    with contextlib.suppress(OSError):
        os.write(1, b"listening\n")
    server.run()
    return 0


if __name__ == "__main__":
    sys.exit(main())
