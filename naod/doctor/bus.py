"""The bus: who listens where we would, and which robots are alive there."""

from __future__ import annotations

import errno
import re
import socket
from collections.abc import Callable
from dataclasses import dataclass

from hal.health import Finding
from naod.bus import keys
from naod.bus.session import open_client
from naod.config import BusConfig
from naod.errors import InputError

PATIENCE_S = 1.0
_TCP = re.compile(r"^tcp/(?P<host>\[[^\]]+\]|[^:/\[\]]+):(?P<port>\d+)")
_LOOPBACK = ("127.", "localhost", "[::1]")


@dataclass(frozen=True, slots=True)
class BusReport:
    """`daemon`: the endpoint where a robot of our name is alive, if it is."""

    findings: list[Finding]
    daemon: str | None


def examine_bus(bus: BusConfig, robot: str) -> BusReport:
    """Every endpoint in turn."""
    found: list[Finding] = []
    daemon = None
    for endpoint in (*bus.listen, *bus.connect):
        alive = robots_at(endpoint)
        if alive is not None and robot in alive:
            daemon = daemon or endpoint
        if endpoint in bus.listen:
            found.append(_listening(endpoint, alive))
        else:
            found.append(_connecting(endpoint, alive))
    return BusReport(found, daemon)


def robots_at(endpoint: str) -> tuple[str, ...] | None:
    """Names of the robots alive there; None when nobody speaks zenoh there."""
    try:
        session = open_client(endpoint, PATIENCE_S)
    except InputError:
        return None
    try:
        replies = session.liveliness().get(keys.key("*", keys.ALIVE), timeout=PATIENCE_S)
        answers = [str(reply.ok.key_expr) for reply in replies if reply.ok is not None]
    finally:
        close: Callable[[], None] = session.close
        close()
    return tuple(sorted({answer.split("/")[1] for answer in answers}))


def _listening(endpoint: str, alive: tuple[str, ...] | None) -> Finding:
    if alive:
        return Finding("bus", "ok", f"{endpoint}: {', '.join(alive)} alive")
    if alive is not None:
        text = f"{endpoint}: somebody speaks zenoh there, and no robot is alive"
        return Finding("bus", "warn", text, "end it, or listen elsewhere")
    trouble = _cannot_listen(endpoint)
    if trouble:
        return Finding("bus", "fail", f"{endpoint}: {trouble}", "set bus.listen to another one")
    if not _is_loopback(endpoint):
        text = f"{endpoint}: free, and open to the network"
        advice = "whoever reaches it may drive the robot: see to it that only you do"
        return Finding("bus", "warn", text, advice)
    return Finding("bus", "ok", f"{endpoint}: free; no daemon runs")


def _connecting(endpoint: str, alive: tuple[str, ...] | None) -> Finding:
    if alive is None:
        advice = "start the router there, or take it out of bus.connect"
        return Finding("bus", "warn", f"{endpoint}: nobody answers", advice)
    return Finding("bus", "ok", f"{endpoint}: answers, {len(alive)} robots alive")


def _is_loopback(endpoint: str) -> bool:
    found = _TCP.match(endpoint)
    return found is None or found["host"].startswith(_LOOPBACK)


def _cannot_listen(endpoint: str) -> str:
    """Why a daemon could not listen there; "" if it could, or it is not TCP."""
    found = _TCP.match(endpoint)
    if found is None:
        return ""
    host = found["host"].strip("[]")
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        with socket.socket(family, socket.SOCK_STREAM) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind((host, int(found["port"])))
            probe.listen(1)
    except (OSError, OverflowError) as error:
        if isinstance(error, OSError) and error.errno == errno.EADDRINUSE:
            return "another program has the port"
        return str(getattr(error, "strerror", None) or error)
    return ""
