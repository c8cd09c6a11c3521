"""Opening zenoh: no multicast unless configured, listening only where configured."""

from __future__ import annotations

import json
import re

import zenoh

from naod.config import BusConfig
from naod.errors import InputError

LOOPBACK = "tcp/127.0.0.1:7447"

# a control message is small; pictures come later and are published, never received
_RECEIVE_BYTES_MAX = 1 << 20


def open_server(bus: BusConfig) -> zenoh.Session:
    """The daemon's side. Raises InputError naming the endpoint: in use, impossible, malformed."""
    config = _base("peer", bus.multicast)
    for endpoint in (*bus.listen, *bus.connect):
        _check(endpoint)
    _insert(config, "listen/endpoints", list(bus.listen))
    _insert(config, "listen/exit_on_failure", True)
    _insert(config, "connect/endpoints", list(bus.connect))
    # a router that is not up yet must not keep the robot from starting
    _insert(config, "connect/timeout_ms", 0)
    _insert(config, "connect/exit_on_failure", False)
    try:
        return zenoh.open(config)
    except zenoh.ZError as error:
        raise InputError(_listening(bus.listen, str(error))) from None


def open_client(endpoint: str, timeout_s: float = 1.5) -> zenoh.Session:
    """The side of a remote control. Raises InputError when nobody is there."""
    _check(endpoint)
    config = _base("client", multicast=False)
    _insert(config, "connect/endpoints", [endpoint])
    _insert(config, "connect/timeout_ms", int(timeout_s * 1000))
    _insert(config, "connect/exit_on_failure", True)
    try:
        return zenoh.open(config)
    except zenoh.ZError:
        raise InputError(f"no daemon answers at {endpoint}") from None


def _base(mode: str, multicast: bool) -> zenoh.Config:
    config = zenoh.Config()
    _insert(config, "mode", mode)
    _insert(config, "scouting/multicast/enabled", multicast)
    _insert(config, "scouting/gossip/enabled", multicast)
    # shared memory would leave segments behind when a process is killed
    _insert(config, "transport/shared_memory/enabled", False)
    _insert(config, "transport/link/rx/max_message_size", _RECEIVE_BYTES_MAX)
    return config


def _insert(config: zenoh.Config, key: str, value: object) -> None:
    config.insert_json5(key, json.dumps(value))


def _check(endpoint: str) -> None:
    try:
        _insert(zenoh.Config(), "connect/endpoints", [endpoint])
    except zenoh.ZError:
        raise InputError(
            f"endpoint {endpoint!r}: write it as PROTOCOL/ADDRESS, like {LOOPBACK}"
        ) from None


def _listening(endpoints: tuple[str, ...], text: str) -> str:
    """One line of zenoh's many: which endpoint, and why."""
    guilty = next((e for e in endpoints if e in text), ", ".join(endpoints))
    if "Address already in use" in text:
        return f"cannot listen on {guilty}: the port is in use (is another daemon running?)"
    system = re.search(r"([A-Z][\w ]+) \(os error \d+\)", text)
    plain = re.sub(r"\s+at /.*?:\d+\.?", "", " ".join(text.split())).strip(" [].")
    return f"cannot listen on {guilty}: {system.group(1) if system else plain}"
