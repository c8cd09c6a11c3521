"""A robot that a daemon has: the daemon is asked, for two cannot have it."""

from __future__ import annotations

from typing import Any

from hal.health import Finding
from naod.bus.client import CallError, Client
from naod.errors import InputError

HOT_C = 70.0
BATTERY_LOW = 0.2
LATENCY_MAX_MS = 500.0


def examine_daemon(endpoint: str, robot: str) -> list[Finding]:
    """What a running daemon says of itself."""
    try:
        with Client(endpoint, robot) as client:
            told = client.call("status")
    except (InputError, CallError) as error:
        advice = "it is alive and does not answer: restart it, see its log"
        return [Finding("daemon", "fail", str(error), advice)]
    found = [_who(told)]
    if told.get("estopped"):
        found.append(Finding("estop", "warn", "latched: nothing will move", "`naod ctl release`"))
    state, gauges = told.get("state"), told.get("diagnostics")
    for fault in (state or {}).get("faults", ()):
        found.append(Finding("fault", "warn", str(fault), "`naod ctl watch` tells more"))
    return found + (_gauges(gauges) if gauges else [])


def _who(told: dict[str, Any]) -> Finding:
    robot, state = told["robot"], told.get("state") or {}
    mode = state.get("mode", "starting")
    text = f"version {told['version']}, backend {robot['backend']}, {robot['version']}, {mode}"
    return Finding("daemon", "ok", text)


def _gauges(told: dict[str, Any]) -> list[Finding]:
    period, worst = told["period_ms"], told["period_max_ms"]
    text = f"period {period:.0f} ms, {worst:.0f} at worst, {told['overruns']} overruns"
    found = [Finding("loop", "ok", text)]
    if told["frames"] == 0:
        advice = "is the camera there? see the daemon's log"
        found.append(Finding("camera", "fail", "no pictures in the last second", advice))
    else:
        latency = told["latency_ms"]
        late = latency > LATENCY_MAX_MS
        text = f"{told['frames']} pictures in the last second, {latency:.0f} ms old when used"
        advice = "the machine is too busy, or the clocks differ" if late else ""
        found.append(Finding("camera", "warn" if late else "ok", text, advice))
    hot, low = told["temperature_max_c"] > HOT_C, told["battery"] < BATTERY_LOW
    warmest = f"warmest {told['temperature_max_c']:.0f} C"
    found.append(
        Finding("joints", "warn" if hot else "ok", warmest, "let them cool" if hot else "")
    )
    charge = f"{told['battery']:.0%}"
    found.append(Finding("battery", "warn" if low else "ok", charge, "charge it" if low else ""))
    return found
