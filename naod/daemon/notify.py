"""Telling systemd how we are: readiness, the watchdog, stopping (sd_notify's datagrams)."""

from __future__ import annotations

import logging
import os
import socket

log = logging.getLogger(__name__)


class Notifier:
    """Sends to the socket named by NOTIFY_SOCKET; does nothing without one."""

    def __init__(self, address: str | None) -> None:
        self._address = address
        self._socket: socket.socket | None = None
        if address is not None:
            self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC)
            # the loop must not wait for systemd
            self._socket.setblocking(False)

    @classmethod
    def from_environment(cls) -> Notifier:
        """The socket that systemd gave us, if it did."""
        return cls(os.environ.get("NOTIFY_SOCKET") or None)

    def ready(self) -> None:
        """Start-up is over."""
        self._send("READY=1")

    def alive(self) -> None:
        """Feed the watchdog."""
        self._send("WATCHDOG=1")

    def stopping(self) -> None:
        """We are closing down."""
        self._send("STOPPING=1")

    def status(self, text: str) -> None:
        """One line for `systemctl status`."""
        self._send(f"STATUS={text}")

    def close(self) -> None:
        """Let go of the socket."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    def _send(self, text: str) -> None:
        if self._socket is None or self._address is None:
            return
        # an abstract name is written with @ and begins with a zero byte
        address = self._address
        place = "\0" + address[1:] if address.startswith("@") else address
        try:
            self._socket.sendto(text.encode(), place)
        except OSError as error:
            log.debug("systemd does not hear %s: %s", text, error)
