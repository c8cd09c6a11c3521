"""Being scheduled first, where the kernel allows it."""

from __future__ import annotations

import contextlib
import ctypes
import gc
import os

PRIORITY = 20
"""Below LoLA's own and the HAL's, which may have up to 36 (`lola_protocol.yaml`, autostart)."""

NICE = -10
_CURRENT_AND_FUTURE = 3


def be_first() -> bool:
    """Ask for real-time priority and locked memory; whether the first was granted.

    The garbage collector goes: a tick leaves no cycles behind.
    """
    gc.collect()
    gc.freeze()
    gc.disable()
    with contextlib.suppress(OSError, AttributeError):
        # paging in code costs more than a tick has; refused, it is done without
        ctypes.CDLL(None, use_errno=True).mlockall(_CURRENT_AND_FUTURE)
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
    except OSError:
        with contextlib.suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, 0, NICE)
        return False
    return True
