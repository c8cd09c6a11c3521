"""Who is on the bus: real sessions and sockets, on free ports of loopback."""

import json
import socket

import msgspec
import pytest

from naod.bus.session import open_server
from naod.config import BusConfig
from naod.doctor.bus import examine_bus
from naod.doctor.daemon import examine_daemon
from naod.messages import RobotMessage, StatusReply


@pytest.fixture
def endpoint():
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    return f"tcp/127.0.0.1:{port}"


@pytest.fixture
def session(endpoint):
    session = open_server(BusConfig(listen=(endpoint,)))
    yield session
    session.close()


def statuses(report):
    return [(finding.status, finding.text.split(": ")[1]) for finding in report.findings]


def test_a_free_port_is_well_and_stays_free(endpoint):
    report = examine_bus(BusConfig(listen=(endpoint,)), "nao")
    assert statuses(report) == [("ok", "free; no daemon runs")]
    assert report.daemon is None
    host, port = endpoint.removeprefix("tcp/").split(":")
    socket.create_server((host, int(port))).close()


def test_another_program_on_the_port_fails(endpoint):
    host, port = endpoint.removeprefix("tcp/").split(":")
    with socket.create_server((host, int(port))):
        report = examine_bus(BusConfig(listen=(endpoint,)), "nao")
    assert statuses(report) == [("fail", "another program has the port")]


def test_a_robot_that_is_alive_is_found_by_name(endpoint, session):
    bus = BusConfig(listen=(endpoint,))
    assert statuses(examine_bus(bus, "nao"))[0][0] == "warn"
    token = session.liveliness().declare_token("nao/nao/alive")
    report = examine_bus(bus, "nao")
    assert statuses(report) == [("ok", "nao alive")]
    assert report.daemon == endpoint
    assert examine_bus(bus, "other").daemon is None
    token.undeclare()


def test_an_open_port_and_a_silent_router_are_told(endpoint):
    port = endpoint.split(":")[1]
    bus = BusConfig(listen=(f"tcp/0.0.0.0:{port}",), connect=(endpoint,))
    found = examine_bus(bus, "nao").findings
    assert [finding.status for finding in found] == ["warn", "warn"]
    assert "open to the network" in found[0].text
    assert "nobody answers" in found[1].text


def reply(**diagnostics):
    robot = RobotMessage(name="nao", version="v6", backend="lola", simulated=False)
    told = StatusReply(
        version="1", robot=robot, estopped=True, labelled=False, goals=(), state=None, walk=None,
        diagnostics=None,
    )  # fmt: skip
    tree = json.loads(msgspec.json.encode(told))
    return json.dumps({**tree, "diagnostics": diagnostics or None}).encode()


WELL = {
    "period_ms": 66.0, "period_max_ms": 70.0, "jitter_ms": 1.0, "latency_ms": 80.0, "overruns": 0,
    "frames": 15, "refused": 0, "memory_mb": 200.0, "temperature_max_c": 50.0, "battery": 0.8,
    "stamp_ns": 1,
}  # fmt: skip


@pytest.mark.parametrize(
    ("change", "check", "status"),
    [
        ({}, "camera", "ok"),
        ({"frames": 0}, "camera", "fail"),
        ({"latency_ms": 900.0}, "camera", "warn"),
        ({"temperature_max_c": 80.0}, "joints", "warn"),
        ({"battery": 0.1}, "battery", "warn"),
    ],
)
def test_a_daemon_is_asked(endpoint, session, change, check, status):
    payload = reply(**{**WELL, **change})
    queryable = session.declare_queryable(
        "nao/nao/rpc/status", lambda query: query.reply(query.key_expr, payload)
    )
    found = {finding.check: finding for finding in examine_daemon(endpoint, "nao")}
    assert found[check].status == status
    assert found["estop"].status == "warn"
    assert "backend lola" in found["daemon"].text
    queryable.undeclare()


def test_a_daemon_that_does_not_answer_fails(endpoint, session):
    assert session
    (found,) = examine_daemon(endpoint, "nao")
    assert found.status == "fail"
