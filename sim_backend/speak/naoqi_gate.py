"""The login of NAOqi 2.9 before the services, as `qi` puts it on the wire.

The first message of a connection calls method 8 of service 0 with a map of capabilities, user and
token among them. A wrong one is answered with an error message and a closed connection, a right one
is passed on. With a certificate the gate speaks TLS, as NAOqi does on port 9503. The bytes: header
of 28 (magic, id, size, version, type, flags, service, object, action), little-endian; texts with
their length before them; values with their signature before them.
"""

from __future__ import annotations

import socket
import ssl
import struct
import threading
from contextlib import suppress
from urllib.parse import urlsplit

from hal.errors import BackendError
from sim_backend.speak.naoqi_options import PeerOptions

MAGIC = 0x42ADDE42
HEADER = struct.Struct("<IIIHBBIII")
TYPE_CALL, TYPE_ERROR = 1, 3
AUTHENTICATE = 8
SIZE_MAX = 1 << 16


class Gate:
    """Listens, lets in who knows the password, and passes bytes both ways."""

    def __init__(self, url: str, inner: str, told: PeerOptions) -> None:
        parts, self._inner, self._told = urlsplit(url), urlsplit(inner), told
        self._tls: ssl.SSLContext | None = None
        if told.certificate:
            self._tls = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
            self._tls.load_cert_chain(told.certificate, told.key or None)
        try:
            self._socket = socket.create_server((parts.hostname or "127.0.0.1", parts.port or 0))
        except OSError as error:
            raise BackendError(f"cannot listen on {url}: {error}") from None
        host, port = self._socket.getsockname()[:2]
        self.url = f"{'tcps' if self._tls else 'tcp'}://{host}:{port}"
        self._open: list[socket.socket] = []
        self._thread = threading.Thread(target=self._accept, name="naoqi-gate", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End every connection."""
        # a thread in accept() is woken by shutting the socket down, not by closing it
        for one in (self._socket, *self._open):
            with suppress(OSError):
                one.shutdown(socket.SHUT_RDWR)
            one.close()
        self._thread.join(timeout=2.0)

    def _accept(self) -> None:
        while True:
            try:
                client, _ = self._socket.accept()
            except OSError:
                return
            threading.Thread(target=self._admit, args=(client,), daemon=True).start()

    def _admit(self, client: socket.socket) -> None:
        try:
            if self._tls is not None:
                client = self._tls.wrap_socket(client, server_side=True)
            header, payload = _message(client)
        except (OSError, ValueError):
            client.close()
            return
        if not _is_login(header, payload, self._told):
            with suppress(OSError):
                client.sendall(_refusal(header))
            client.close()
            return
        server = socket.create_connection((self._inner.hostname or "", self._inner.port or 0))
        self._open += [client, server]
        server.sendall(header + payload)
        threading.Thread(target=_pass_on, args=(server, client), daemon=True).start()
        _pass_on(client, server)


def login_in(payload: bytes) -> dict[str, str]:
    """The texts in a map of capabilities, {sm}. Raises ValueError."""
    found: dict[str, str] = {}
    try:
        (count,) = struct.unpack_from("<I", payload)
        at = 4
        for _ in range(count):
            name, at = _text(payload, at)
            signature, at = _text(payload, at)
            while signature == "m":
                signature, at = _text(payload, at)
            if signature == "s":
                found[name], at = _text(payload, at)
            else:
                at += struct.calcsize(f"<{_SIZES[signature]}")
    except (struct.error, KeyError, UnicodeDecodeError) as error:
        raise ValueError(f"no map of capabilities: {error}") from None
    return found


_SIZES = {"b": "?", "i": "i", "I": "I", "l": "q", "L": "Q", "f": "f", "d": "d"}


def _text(data: bytes, at: int) -> tuple[str, int]:
    (length,) = struct.unpack_from("<I", data, at)
    end = at + 4 + length
    if end > len(data):
        raise struct.error("a text ends after its message")
    return data[at + 4 : end].decode(), end


def _message(client: socket.socket) -> tuple[bytes, bytes]:
    header = _exactly(client, HEADER.size)
    magic, _, size, *_ = HEADER.unpack(header)
    if magic != MAGIC or size > SIZE_MAX:
        raise ValueError("not a message of qi")
    return header, _exactly(client, size)


def _exactly(client: socket.socket, size: int) -> bytes:
    data = b""
    while len(data) < size:
        more = client.recv(size - len(data))
        if not more:
            raise ValueError("the connection ends in a message")
        data += more
    return data


def _is_login(header: bytes, payload: bytes, told: PeerOptions) -> bool:
    _, _, _, _, kind, _, service, _, action = HEADER.unpack(header)
    if (kind, service, action) != (TYPE_CALL, 0, AUTHENTICATE):
        return False
    try:
        found = login_in(payload)
    except ValueError:
        return False
    return (found.get("auth_user"), found.get("auth_token")) == (told.user, told.password)


def _refusal(header: bytes) -> bytes:
    _, number, _, _, _, _, service, thing, action = HEADER.unpack(header)
    text = b"Authentication failed"
    body = struct.pack("<I", 1) + b"s" + struct.pack("<I", len(text)) + text
    head = HEADER.pack(MAGIC, number, len(body), 0, TYPE_ERROR, 0, service, thing, action)
    return head + body


def _pass_on(source: socket.socket, sink: socket.socket) -> None:
    with suppress(OSError):
        while data := source.recv(65536):
            sink.sendall(data)
    for end in (source, sink):
        with suppress(OSError):
            end.shutdown(socket.SHUT_RDWR)
