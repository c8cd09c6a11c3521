"""Every pitfall of the qi package that was found, met by a real server in a process of its own."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator

import numpy as np
import pytest
from naoqi_peer import until

from hal.errors import BackendError
from hal.naoqi.errors import (
    CallRefusedError,
    NoAnswerError,
    NotConnectedError,
    ServiceMissingError,
)
from hal.naoqi.session import Session

pytest.importorskip("qi", reason="the package qi is not installed")

SERVER = """
import qi, sys, threading
qi.logging.setLevel(qi.logging.FATAL)
class Slow:
    def wait(self, s): threading.Event().wait(s); return True
    def quick(self): return 1
@qi.multiThreaded()
class Echo:
    def kind(self, value): return type(value).__name__
    def back(self, value): return value
    def fail(self): raise ValueError("it does not want to\\nand says why at length")
    def wait(self, s): threading.Event().wait(s); return True
    def some(self, *values): return len(values)
    @qi.bind("(ir)", ())
    def raw(self): return (3, bytes(range(256)))
    def text(self): return [3, bytes(range(256))]
session = qi.Session()
session.listenStandalone(sys.argv[1])
session.registerService("Echo", Echo())
session.registerService("Slow", Slow())
print(session.endpoints()[0], flush=True)
sys.stdin.read()
"""


class Server:
    def __init__(self, url: str = "tcp://127.0.0.1:0") -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-c", SERVER, url],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        assert self.process.stdout is not None
        self.url = self.process.stdout.readline().strip()

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()
        for pipe in (self.process.stdin, self.process.stdout):
            assert pipe is not None
            pipe.close()


@pytest.fixture(scope="module")
def server() -> Iterator[Server]:
    found = Server()
    yield found
    found.kill()


@pytest.fixture
def session(server: Server) -> Iterator[Session]:
    found = Session(server.url, None)
    yield found
    found.close()


@pytest.mark.parametrize(
    ("value", "kind", "same"),
    [
        (np.float64(0.25), "float", 0.25),
        (np.float32(0.25), "float", 0.25),
        (np.int64(7), "int", 7),
        (np.bool_(True), "bool", True),
        (np.array([[1.0, 2.0]]), "list", [[1.0, 2.0]]),
        ((1, "a", None), "list", [1, "a", None]),
        ({"a": np.int32(1)}, "dict", {"a": 1}),
        ([["MaxStepX", np.float64(0.04)]], "list", [["MaxStepX", 0.04]]),
        (2**40, "int", 2**40),
        ("ä", "str", "ä"),
    ],
)
def test_numpy_and_plain_values_cross(session, value, kind, same):
    assert session.call("Echo", "kind", value) == kind
    assert session.call("Echo", "back", value) == same


@pytest.mark.parametrize("value", [b"a", bytearray(b"a"), memoryview(b"a"), [b"a"], object()])
def test_what_qi_would_spoil_is_refused_before_it_is_sent(session, value):
    with pytest.raises(TypeError):
        session.call("Echo", "back", value)


def test_declared_bytes_cross_and_undeclared_ones_come_as_a_text(session):
    assert session.call("Echo", "raw") == (3, bytearray(range(256)))
    assert session.call("Echo", "text") == [3, repr(bytes(range(256)))]


def test_optional_arguments_find_their_method(session):
    assert session.call("Echo", "some", 1.0, 2.0, 3.0) == 3
    assert session.call("Echo", "some", 1.0, 2.0, 3.0, [["MaxStepX", 0.04]]) == 4


@pytest.mark.parametrize(
    ("service", "method", "args", "error", "told"),
    [
        ("Echo", "fail", (), CallRefusedError, "Echo.fail: ValueError: it does not want to"),
        ("Nobody", "fail", (), ServiceMissingError, "Nobody"),
        ("Echo", "nothing", (), ServiceMissingError, "Echo has no method nothing"),
        ("Echo", "kind", (1, 2), ServiceMissingError, "other arguments"),
    ],
)
def test_errors_are_ours_and_of_one_line(session, service, method, args, error, told):
    with pytest.raises(error, match=told) as caught:
        session.call(service, method, *args)
    assert "\n" not in str(caught.value)
    assert session.call("Echo", "back", 1) == 1


def test_has_knows_services_and_methods(session):
    assert session.has("Echo")
    assert session.has("Echo", "kind")
    assert not session.has("Echo", "nothing")
    assert not session.has("Nobody")


def test_answer_that_does_not_come_in_time(session):
    with pytest.raises(NoAnswerError, match="no answer within"):
        session.call("Echo", "wait", 0.5, timeout_s=0.05)


def test_blocking_call_delays_no_other_of_a_service_that_is_threaded(session):
    waiting = session.post("Echo", "wait", 1.0)
    assert session.call("Echo", "back", 1, timeout_s=0.8) == 1
    assert not waiting.done
    assert waiting.result(3.0) is True


def test_service_that_is_not_threaded_delays_only_its_own_calls(session):
    waiting = session.post("Slow", "wait", 0.6)
    assert session.call("Echo", "back", 1, timeout_s=0.5) == 1
    quick = session.post("Slow", "quick")
    assert not quick.wait(0.05)
    assert waiting.result(3.0) is True
    assert quick.result(3.0) == 1


def test_nobody_listens():
    begin_s = time.monotonic()
    with pytest.raises(NotConnectedError, match="not reachable: nobody listens"):
        Session("tcp://127.0.0.1:1", None)
    assert time.monotonic() - begin_s < 3.0


def test_url_that_is_none():
    with pytest.raises(NotConnectedError, match="not reachable"):
        Session("tcp://no.such.host.invalid:9559", None)


def test_server_killed_in_flight_then_back_with_services_fetched_again():
    server = Server()
    session = Session(server.url, None)
    assert session.call("Echo", "back", 1) == 1
    waiting = session.post("Echo", "wait", 30.0)
    server.kill()
    with pytest.raises(NotConnectedError, match="connection is lost: Session closed"):
        waiting.result(5.0)
    assert until(lambda: not session.connected)
    with pytest.raises(NotConnectedError):
        session.call("Echo", "back", 1)
    session.close()
    again = Server(server.url)
    session = Session(again.url, None)
    assert session.call("Echo", "back", 2) == 2
    session.close()
    again.kill()


def test_service_first_asked_for_after_a_cut_is_no_refusal(server):
    session = Session(server.url, None)
    assert session.call("Echo", "back", 1) == 1
    session.close()
    for service in ("Echo", "Slow"):
        with pytest.raises(NotConnectedError, match="not connected"):
            session.call(service, "quick")
        with pytest.raises(NotConnectedError):
            session.has(service)


def test_signals_stay_the_daemons_own(server):
    """A qi.Application would take SIGINT and SIGTERM; a session alone does not."""
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    Session(server.url, None).close()
    assert {number: signal.getsignal(number) for number in before} == before


def test_process_with_an_open_connection_ends_by_itself(server):
    code = (
        "import sys\nfrom hal.naoqi.session import Session\n"
        f"s = Session({server.url!r}, None)\nprint(s.call('Echo', 'back', 5))\nsys.exit(3)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=30, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (3, "5\n", "")


def test_no_thread_of_ours_is_left_after_closing(server):
    before = threading.active_count()
    session = Session(server.url, None)
    session.call("Echo", "back", 1)
    session.close()
    session.close()
    assert threading.active_count() == before


def test_missing_package_is_one_line(monkeypatch):
    monkeypatch.setitem(sys.modules, "qi", None)
    with pytest.raises(BackendError, match=r"needs the package qi \(pip install 'naod\[naoqi\]'\)"):
        Session("tcp://127.0.0.1:1", None)
