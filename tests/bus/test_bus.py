"""Two sessions over loopback: publishing, calling, being there, and what goes wrong."""

from __future__ import annotations

import json
import queue
import socket
import threading
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from naod.bus.bus import Answer, Bus
from naod.bus.client import CallError, Client
from naod.bus.session import open_server
from naod.config import BusConfig
from naod.errors import InputError
from naod.messages import GoalCall, NoArguments, WalkCommand

PATIENCE_S = 5.0


def free_endpoint() -> str:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return f"tcp/127.0.0.1:{probe.getsockname()[1]}"


@dataclass
class Pair:
    endpoint: str
    bus: Bus
    client: Client


@pytest.fixture
def pair() -> Iterator[Pair]:
    endpoint = free_endpoint()
    bus = Bus.open(BusConfig(listen=(endpoint,)), "nao")
    client = Client(endpoint, "nao")
    yield Pair(endpoint, bus, client)
    client.close()
    bus.close()


def test_message_goes_from_client_to_daemon(pair: Pair) -> None:
    got: queue.SimpleQueue[WalkCommand] = queue.SimpleQueue()
    pair.bus.subscribe("walk/command", WalkCommand, got.put, pytest.fail)
    sent = WalkCommand(source="op", seq=1, kind="velocity", x=0.1)
    pair.client.publish("walk/command", sent)
    assert got.get(timeout=PATIENCE_S) == sent


def test_message_goes_from_daemon_to_client(pair: Pair) -> None:
    got: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    pair.client.listen("event", got.put)
    # the daemon learns of a subscriber a moment after it was declared
    pair.bus.answer("watch", NoArguments, lambda _call, answer: answer.ok(), pytest.fail)
    pair.client.call("watch")
    pair.bus.publish("event", WalkCommand(source="op", seq=1, kind="stop"))
    assert json.loads(got.get(timeout=PATIENCE_S))["kind"] == "stop"


@pytest.mark.parametrize("payload", [b"{", b"x" * 5000, b'{"source":1}', b""])
def test_what_is_no_message_is_refused_with_its_key(pair: Pair, payload: bytes) -> None:
    reasons: queue.SimpleQueue[str] = queue.SimpleQueue()
    pair.bus.subscribe("walk/command", WalkCommand, pytest.fail, reasons.put)
    pair.client._session.put(pair.client.key("walk/command"), payload)
    assert reasons.get(timeout=PATIENCE_S).startswith("walk/command: ")


def test_deletion_is_refused(pair: Pair) -> None:
    reasons: queue.SimpleQueue[str] = queue.SimpleQueue()
    pair.bus.subscribe("walk/command", WalkCommand, pytest.fail, reasons.put)
    pair.client._session.delete(pair.client.key("walk/command"))
    assert "not a put" in reasons.get(timeout=PATIENCE_S)


def test_call_is_answered_later_from_another_thread(pair: Pair) -> None:
    waiting: queue.SimpleQueue[tuple[GoalCall, Answer]] = queue.SimpleQueue()
    pair.bus.answer(
        "start", GoalCall, lambda call, answer: waiting.put((call, answer)), pytest.fail
    )

    def reply() -> None:
        call, answer = waiting.get(timeout=PATIENCE_S)
        answer.ok(goal=call.goal)
        answer.error("late", "a second answer is not sent")

    thread = threading.Thread(target=reply)
    thread.start()
    assert pair.client.call("start", GoalCall(goal="cup")) == {"ok": True, "goal": "cup"}
    thread.join()


def test_refused_call_carries_code_and_message(pair: Pair) -> None:
    pair.bus.answer(
        "start", GoalCall, lambda _call, answer: answer.error("unknown_goal", "no"), pytest.fail
    )
    with pytest.raises(CallError, match="no") as caught:
        pair.client.call("start", GoalCall(goal="cup"))
    assert caught.value.code == "unknown_goal"


def test_call_that_cannot_be_read_is_answered_and_counted(pair: Pair) -> None:
    reasons: list[str] = []
    pair.bus.answer("start", GoalCall, lambda _call, answer: answer.ok(), reasons.append)
    with pytest.raises(CallError) as caught:
        pair.client.call("start", NoArguments())
    assert caught.value.code == "bad_request"
    assert "goal" in str(caught.value)
    assert len(reasons) == 1


def test_handler_that_fails_is_an_answer_too(pair: Pair) -> None:
    def fail(_call: GoalCall, _answer: Answer) -> None:
        raise RuntimeError("a defect")

    pair.bus.answer("start", GoalCall, fail, pytest.fail)
    with pytest.raises(CallError) as caught:
        pair.client.call("start", GoalCall(goal="cup"))
    assert caught.value.code == "internal"


def test_robot_of_another_name_does_not_answer(pair: Pair) -> None:
    pair.bus.answer("status", NoArguments, lambda _call, answer: answer.ok(), pytest.fail)
    other = Client(pair.endpoint, "other")
    try:
        with pytest.raises(InputError, match="robot 'other' does not answer"):
            other.call("status", timeout_s=1.0)
    finally:
        other.close()


def test_liveliness_token_says_that_the_robot_is_there(pair: Pair) -> None:
    pair.bus.announce()
    key = pair.client.key("alive")
    replies = pair.client._session.liveliness().get(key, timeout=PATIENCE_S)
    assert [str(reply.ok.key_expr) for reply in replies] == ["nao/nao/alive"]


def test_port_in_use_is_one_line_that_names_it(pair: Pair) -> None:
    with pytest.raises(InputError) as caught:
        open_server(BusConfig(listen=(pair.endpoint,)))
    assert pair.endpoint in str(caught.value)
    assert "in use" in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "endpoint", ["nonsense", "tcp/127.0.0.1", "tcp/127.0.0.1:99999", "xyz/127.0.0.1:7447"]
)
def test_impossible_endpoint_is_one_line_that_names_it(endpoint: str) -> None:
    with pytest.raises(InputError) as caught:
        open_server(BusConfig(listen=(endpoint,)))
    assert endpoint in str(caught.value)
    assert "\n" not in str(caught.value)
    assert ".rs" not in str(caught.value)


def test_nobody_there_is_said_soon() -> None:
    endpoint = free_endpoint()
    with pytest.raises(InputError, match=f"no daemon answers at {endpoint}"):
        Client(endpoint, "nao")


def test_router_that_is_not_up_does_not_keep_the_daemon_from_starting() -> None:
    session = open_server(BusConfig(listen=(free_endpoint(),), connect=(free_endpoint(),)))
    session.close()


def listening() -> set[str]:
    """Local addresses, in hexadecimal, of this process's listening TCP and open UDP sockets."""
    ours = {path.readlink().name for path in Path("/proc/self/fd").iterdir() if path.is_symlink()}
    found = set()
    for name, state in (("tcp", "0A"), ("tcp6", "0A"), ("udp", "07"), ("udp6", "07")):
        for line in Path(f"/proc/self/net/{name}").read_text().splitlines()[1:]:
            fields = line.split()
            if fields[3] == state and f"socket:[{fields[9]}]" in ours:
                found.add(fields[1])
    return found


def test_nothing_is_listened_on_but_what_is_configured() -> None:
    before = listening()
    session = open_server(BusConfig(listen=()))
    assert listening() == before
    session.close()


def test_loopback_is_all_that_is_listened_on() -> None:
    before = listening()
    endpoint = free_endpoint()
    session = open_server(BusConfig(listen=(endpoint,)))
    port = int(endpoint.rsplit(":", 1)[1])
    assert listening() - before == {f"0100007F:{port:04X}"}
    session.close()
