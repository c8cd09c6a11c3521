"""NAOqi 2.9's login, on the wire: a user and a password, over TLS or not."""

from __future__ import annotations

import shutil
import struct
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hal.naoqi.errors import LoginError
from hal.naoqi.guard import Guard
from hal.naoqi.login import Login
from hal.naoqi.session import Session
from sim_backend.speak.naoqi_gate import Gate, login_in
from sim_backend.speak.naoqi_options import PeerOptions

qi = pytest.importorskip("qi", reason="the package qi is not installed")

RIGHT = Login("nao", "open sésame")


class Standing:
    """As much of ALMotion as the watchdog asks."""

    def moveIsActive(self) -> bool:
        return False


@pytest.fixture(scope="module")
def inner() -> Iterator[str]:
    session = qi.Session()
    session.listenStandalone("tcp://127.0.0.1:0")
    session.registerService("ALMotion", Standing())
    yield session.endpoints()[0]
    session.close()


@pytest.fixture
def gate(inner: str) -> Iterator[Gate]:
    found = Gate("tcp://127.0.0.1:0", inner, PeerOptions(password=RIGHT.password))
    yield found
    found.close()


def test_right_password_is_let_in(gate):
    session = Session(gate.url, RIGHT)
    assert session.call("ALMotion", "moveIsActive") is False
    session.close()


@pytest.mark.parametrize(
    ("login", "told"),
    [
        (Login("nao", "guess"), "as 'nao' with this password"),
        (Login("pepper", RIGHT.password), "as 'pepper'"),
        (None, "without a password"),
    ],
)
def test_anybody_else_is_not_and_is_told_so_in_one_line(gate, login, told):
    with pytest.raises(LoginError, match=told) as caught:
        Session(gate.url, login)
    assert "\n" not in str(caught.value)
    assert "guess" not in str(caught.value)


def test_login_is_no_hindrance_where_none_is_asked_for(inner):
    session = Session(inner, RIGHT)
    assert session.call("ALMotion", "moveIsActive") is False
    session.close()


def test_tls(inner, tmp_path):
    """As on port 9503. The robot's certificate is its own: qi does not check it."""
    openssl = shutil.which("openssl")
    if openssl is None:
        pytest.skip("openssl is not installed")
    certificate, key = tmp_path / "c.pem", tmp_path / "k.pem"
    words = ["req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=nao"]
    files = ["-keyout", str(key), "-out", str(certificate)]
    subprocess.run([openssl, *words, *files], check=True, capture_output=True)
    told = PeerOptions(password=RIGHT.password, certificate=str(certificate), key=str(key))
    gate = Gate("tcp://127.0.0.1:0", inner, told)
    assert gate.url.startswith("tcps://")
    session = Session(gate.url, RIGHT)
    assert session.call("ALMotion", "moveIsActive") is False
    session.close()
    with pytest.raises(LoginError):
        Session(gate.url, Login("nao", "guess"))
    gate.close()


def test_watchdog_logs_in_too_and_shows_the_password_to_nobody(gate):
    guard = Guard(gate.url, RIGHT)
    guard.start()
    try:
        assert guard.await_ready()
        shown = Path(f"/proc/{guard.pid}/cmdline").read_bytes()
        shown += Path(f"/proc/{guard.pid}/environ").read_bytes()
        assert RIGHT.password.encode() not in shown
    finally:
        guard.close()


def text(value: bytes) -> bytes:
    return struct.pack("<I", len(value)) + value


def test_literal_message():
    """As qi 3.1.5 sends it: capabilities, and user and token as a dynamic in a dynamic."""
    flag = text(b"ClientServerSocket") + text(b"b") + b"\x01"
    user = text(b"auth_user") + text(b"m") + text(b"s") + text(b"nao")
    token = text(b"auth_token") + text(b"m") + text(b"s") + text(b"secret")
    payload = struct.pack("<I", 3) + flag + user + token
    assert login_in(payload) == {"auth_user": "nao", "auth_token": "secret"}
    for size in range(len(payload)):
        with pytest.raises(ValueError, match="no map"):
            login_in(payload[:size])


@given(st.binary(max_size=200))
def test_anything_is_a_login_or_a_value_error(payload):
    try:
        login_in(payload)
    except ValueError:
        return
