"""Our side of the walk's watchdog (`hal.naoqi.watchdog`): it runs as long as we do."""

from __future__ import annotations

import json
import logging
import os
import subprocess
import sys
import threading
import time

from hal.errors import MotionRefusedError
from hal.naoqi.login import Login
from hal.naoqi.watchdog import BEAT_S

log = logging.getLogger(__name__)

SILENT_S = 5.0 * BEAT_S
"""A watchdog that says nothing for so long watches nothing."""
START_S = 15.0
END_S = 2.0


class Guard:
    """Starts the watchdog, tells it deadlines, and knows whether it watches."""

    def __init__(self, url: str, login: Login | None) -> None:
        self._first = json.dumps(
            {
                "url": url,
                "user": login.user if login is not None else "",
                "password": login.password if login is not None else "",
            }
        )
        self._lock = threading.Lock()
        self._news = threading.Condition()
        self._word = ""
        self._heard_s = 0.0
        self._armed = False
        self.fired = 0
        self._process: subprocess.Popen[bytes] | None = None
        self._reader: threading.Thread | None = None

    @property
    def pid(self) -> int | None:
        """The watchdog's process."""
        return None if self._process is None else self._process.pid

    @property
    def objection(self) -> str | None:
        """Why nothing may move: the watchdog does not watch. None if it does."""
        process = self._process
        if process is None or process.poll() is not None:
            return "the walk's watchdog does not run"
        if self._word == "":
            return "the walk's watchdog is not ready yet"
        if self._word == "cut":
            return "the walk's watchdog has no connection to NAOqi"
        if time.monotonic() - self._heard_s > SILENT_S:
            return "the walk's watchdog is silent"
        return None

    def start(self) -> None:
        """Start it, or start it anew if it is gone; nothing if it runs."""
        if self._process is not None and self._process.poll() is None:
            return
        self._end_process()
        self._process = subprocess.Popen(
            [sys.executable, "-m", "hal.naoqi.watchdog"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            # Ctrl-C in a terminal is for the daemon, which then ends it in order
            start_new_session=True,
        )
        assert self._process.stdin is not None
        self._word, self._heard_s = "", time.monotonic()
        os.set_blocking(self._process.stdin.fileno(), False)
        self._reader = threading.Thread(
            target=self._read, args=(self._process,), name="naoqi-guard", daemon=True
        )
        self._reader.start()
        self._tell(self._first)

    def await_ready(self) -> bool:
        """Wait until it watches; false if it does not come to that."""
        with self._news:
            return self._news.wait_for(lambda: self._word == "ok", START_S)

    def arm(self, deadline_ns: int) -> None:
        """The robot is stopped at this time (monotonic) unless told again.

        Raises MotionRefusedError when the watchdog does not watch.
        """
        objection = self.objection
        self._armed = True
        if objection is None and not self._tell(f"arm {deadline_ns}"):
            objection = "the walk's watchdog does not listen"
        if objection is not None:
            raise MotionRefusedError(objection)

    def disarm(self) -> None:
        """Nothing moves any more."""
        if self._armed:
            self._armed = False
            self._tell("disarm")

    def close(self) -> None:
        """End it; if something is armed, only after the robot has been stopped."""
        self._tell("end")
        self._end_process()

    def _tell(self, line: str) -> bool:
        with self._lock:
            if self._process is None or self._process.stdin is None:
                return False
            try:
                # not blocking: a pipe that is full has nobody at its other end
                os.write(self._process.stdin.fileno(), f"{line}\n".encode())
            except (OSError, ValueError):
                return False
        return True

    def _read(self, process: subprocess.Popen[bytes]) -> None:
        assert process.stdout is not None
        for raw in process.stdout:
            word = raw.decode().strip()
            with self._news:
                self._heard_s = time.monotonic()
                if word == "fired":
                    self.fired += 1
                    log.warning("the walk's watchdog has stopped the robot")
                else:
                    self._word = word
                self._news.notify_all()

    def _end_process(self) -> None:
        with self._lock:
            process, self._process = self._process, None
            if process is None:
                return
            if process.stdin is not None:
                process.stdin.close()
        try:
            process.wait(END_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        if self._reader is not None:
            self._reader.join(END_S)
        if process.stdout is not None:
            process.stdout.close()
