"""The machine: real-time rights, its clock's governor, compiled kernels."""

from __future__ import annotations

import os
import platform
import resource
from pathlib import Path

from hal.health import Finding

SYS = Path("/sys/devices/system/cpu")
STATUS = Path("/proc/self/status")
_CAP_SYS_NICE = 1 << 23
_SLOW = frozenset({"powersave", "conservative"})


def examine_machine(needs_real_time: bool, sys: Path = SYS, status: Path = STATUS) -> list[Finding]:
    """Everything about the machine; `needs_real_time`: a backend wants to answer in time."""
    return [_what(), _rights(needs_real_time, status), _governor(sys), _kernels()]


def _what() -> Finding:
    cores = len(os.sched_getaffinity(0))
    text = f"Python {platform.python_version()}, {cores} cores, {platform.machine()}"
    if cores < 2:
        advice = "perception will be late: leave the daemon two cores"
        return Finding("machine", "warn", text, advice)
    return Finding("machine", "ok", text)


def _rights(needed: bool, status: Path) -> Finding:
    _, most = resource.getrlimit(resource.RLIMIT_RTPRIO)
    if most == resource.RLIM_INFINITY or most > 0 or _may_nice(status):
        return Finding("real-time rights", "ok", "real-time priority may be had")
    if not needed:
        return Finding("real-time rights", "ok", "none, and this backend needs none")
    advice = "LimitRTPRIO=20 in the service, or an entry in /etc/security/limits.conf"
    return Finding("real-time rights", "warn", "real-time priority may not be had", advice)


def _may_nice(status: Path) -> bool:
    try:
        rows = status.read_text(encoding="ascii").splitlines()
        mask = next(row.split()[1] for row in rows if row.startswith("CapEff:"))
        return bool(int(mask, 16) & _CAP_SYS_NICE)
    except (OSError, ValueError, StopIteration, IndexError):
        return False


def _governor(sys: Path) -> Finding:
    found = set()
    for path in sorted(sys.glob("cpu[0-9]*/cpufreq/scaling_governor")):
        try:
            found.add(path.read_text(encoding="ascii").strip())
        except OSError:
            continue
    if not found:
        return Finding("processor clock", "ok", "this machine does not tell how it is governed")
    text = f"governed by {', '.join(sorted(found))}"
    if found & _SLOW:
        return Finding("processor clock", "warn", text, "set the governor to performance")
    return Finding("processor clock", "ok", text)


def _kernels() -> Finding:
    folder = Path(os.environ.get("NUMBA_CACHE_DIR", ""))
    count = sum(1 for _ in folder.rglob("*.nbi")) if folder.is_absolute() else 0
    if count:
        return Finding("kernels", "ok", f"{count} compiled")
    parent = next((p for p in (folder, *folder.parents) if p.exists()), folder)
    if not os.access(parent, os.W_OK):
        text = f"none compiled, and {parent} cannot be written"
        return Finding("kernels", "fail", text, "set NUMBA_CACHE_DIR to a folder that can")
    advice = "the first start takes a minute or two; later ones do not"
    return Finding("kernels", "warn", "none compiled yet", advice)
