"""What the LoLA backend says of itself when it is examined."""

from __future__ import annotations

from hal.errors import HalError
from hal.health import Finding, Status
from hal.lola.line import Line
from hal.lola.shared import LolaStatus

LATE_MAX_PER_100000 = 100.0
BATTERY_LOW = 0.2


def findings(line: Line) -> list[Finding]:
    """Connection, timing, joints, battery; see `hal.health.Examined`."""
    try:
        status, body = line.status(), line.shared.newest()
    except HalError as error:
        return [Finding("lola", "fail", str(error), "start the daemon anew; see its log")]
    if not status.connected or body is None:
        advice = "is LoLA running, with /home/nao/robocup.conf, and no other program on it?"
        return [Finding("lola", "fail", status.refusal or "silent", advice)]
    low = body.battery < BATTERY_LOW
    battery: Status = "warn" if low else "ok"
    advice = "charge it" if low else ""
    charging = "charging" if status.battery_current_a > 0.0 else "not charging"
    return [
        Finding("lola", "ok", f"robot {status.body_id}, body version {status.version}"),
        _timing(status),
        _real_time(status),
        _joints(status, body.temperature_max_c),
        Finding(
            "battery",
            battery,
            f"{body.battery:.0%}, {charging}",
            "" if battery == "ok" else "charge",
        ),
    ]


def _timing(status: LolaStatus) -> Finding:
    text = f"{status.ticks} answers, {status.late} late, {status.bad} unreadable messages"
    text += f", {status.connections} connections"
    rate = 1e5 * status.late / max(status.ticks, 1)
    if rate > LATE_MAX_PER_100000 or status.bad:
        return Finding(
            "lola timing", "warn", text, "allow real-time priority, or leave a core free"
        )
    return Finding("lola timing", "ok", text)


def _real_time(status: LolaStatus) -> Finding:
    if status.real_time:
        return Finding("lola priority", "ok", "real-time priority")
    advice = "LimitRTPRIO=20 in the service, or an entry in /etc/security/limits.conf"
    return Finding("lola priority", "warn", "no real-time priority was granted", advice)


def _joints(status: LolaStatus, temperature_c: float) -> Finding:
    text = f"warmest {temperature_c:.0f} C, {status.mode}, {status.phase}"
    if status.hot:
        return Finding("joints", "warn", f"hot: {', '.join(status.hot)}; {text}", "let them cool")
    if status.soft:
        advice = "LoLA or a motor board cut their stiffness: calibration, sensor or heat"
        return Finding("joints", "warn", f"soft: {', '.join(status.soft)}; {text}", advice)
    return Finding("joints", "ok", text)
