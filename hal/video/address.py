"""Addresses of a frame socket: tcp://HOST:PORT, unix:PATH, or the path of a socket."""

from __future__ import annotations

import contextlib
import os
import re
import socket
import stat
from dataclasses import dataclass
from pathlib import Path

from hal.errors import BackendError

_TCP = re.compile(r"^tcp://(?P<host>\[[0-9A-Fa-f:.]+\]|[^\[\]:/@\s]+):(?P<port>[0-9]{1,5})/?$")
_SCHEMES = ("tcp://", "unix:")
_BACKLOG = 8


@dataclass(frozen=True, slots=True)
class Address:
    """`path` of a Unix socket, or else `host` and `port`."""

    path: str = ""
    host: str = ""
    port: int = 0

    def __str__(self) -> str:
        if self.path:
            return f"unix:{self.path}"
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"tcp://{host}:{self.port}"


def is_address(text: str) -> bool:
    """Whether it says that it is an address, or is the path of a socket that is there."""
    if text.startswith(_SCHEMES):
        return True
    try:
        return stat.S_ISSOCK(os.stat(text).st_mode)
    except (OSError, ValueError):
        return False


def parse_address(text: str) -> Address:
    """Read an address. Raises BackendError."""
    if text.startswith("tcp://"):
        found = _TCP.match(text)
        if found is None or int(found["port"]) > 65535:
            raise BackendError(f"{text!r}: want tcp://HOST:PORT")
        return Address(host=found["host"].strip("[]"), port=int(found["port"]))
    path = text.removeprefix("unix:").removeprefix("//")
    # sun_path holds 108 bytes and ends with a zero
    if not path or "\0" in path or len(os.fsencode(path)) > 107:
        raise BackendError(f"{text!r}: want unix:PATH, PATH of 1 to 107 bytes")
    return Address(path=path)


def connected(address: Address, timeout_s: float) -> socket.socket:
    """Connect. Raises OSError."""
    if not address.path:
        link = socket.create_connection((address.host, address.port), timeout_s)
        link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return link
    link = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        link.settimeout(timeout_s)
        link.connect(address.path)
    except BaseException:
        link.close()
        raise
    return link


def listening(address: Address) -> tuple[socket.socket, Address]:
    """Listen; returns the address with the port that port 0 became. Raises BackendError."""
    try:
        return _listening(address)
    except OSError as error:
        raise BackendError(f"{address}: cannot listen: {error.strerror or error}") from None


def _listening(address: Address) -> tuple[socket.socket, Address]:
    if not address.path:
        family = socket.AF_INET6 if ":" in address.host else socket.AF_INET
        link = socket.create_server((address.host, address.port), family=family, backlog=_BACKLOG)
        return link, Address(host=address.host, port=link.getsockname()[1])
    _remove_orphan(address)
    link = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        link.bind(address.path)
        os.chmod(address.path, 0o600)
        link.listen(_BACKLOG)
    except BaseException:
        link.close()
        raise
    return link, address


def forget(address: Address) -> None:
    """Remove a Unix socket's path."""
    if address.path:
        with contextlib.suppress(OSError):
            Path(address.path).unlink()


def _remove_orphan(address: Address) -> None:
    """A socket that nobody listens on any more may go; one that is in use, or a file, may not."""
    try:
        if not stat.S_ISSOCK(os.stat(address.path).st_mode):
            return
    except OSError:
        return
    try:
        connected(address, 1.0).close()
    except ConnectionRefusedError:
        forget(address)
