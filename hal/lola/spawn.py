"""Getting hold of the process of LoLA: the one that runs already, or one started now."""

from __future__ import annotations

import os
import select
import socket
import subprocess
import sys

import msgspec

from hal.errors import BackendError
from hal.lola.channel import receive_memory
from hal.lola.client import meeting_place
from hal.lola.shared import Shared
from hal.lola.told import Told

START_S = 20.0
"""Starting Python on the robot's slow disk, or another process of ours sitting down."""


def hired(told: Told) -> tuple[socket.socket, Shared]:
    """A process that serves LoLA, ours alone. Raises BackendError."""
    link = _met(told.socket)
    memory = None if link is None else _memory(link)
    if link is None or memory is None:
        _start(told)
        link = _met(told.socket)
        memory = None if link is None else _memory(link)
        if link is None or memory is None:
            raise BackendError(f"{told.socket}: the process of LoLA ended at once; see its lines")
    link.setblocking(False)
    return link, memory


def _met(path: str) -> socket.socket | None:
    """A connection to the process for this path; None if there is none."""
    link = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    link.settimeout(START_S)
    try:
        link.connect(meeting_place(path))
    except OSError:
        link.close()
        return None
    return link


def _memory(link: socket.socket) -> Shared | None:
    """What it shares; None if it ended instead. Raises BackendError if it has another client."""
    try:
        fd = receive_memory(link)
    except ConnectionError:
        link.close()
        return None
    except BackendError:
        link.close()
        raise
    try:
        return Shared(fd)
    finally:
        os.close(fd)


def _start(told: Told) -> None:
    """Start one, in a session of its own: what stops the daemon must not stop it."""
    process = subprocess.Popen(
        [sys.executable, "-m", "hal.lola.process", msgspec.json.encode(told).decode()],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        start_new_session=True,
        # its arrays are too small for threads
        env={**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"},
    )
    assert process.stdout is not None
    with process.stdout as told_ready:
        select.select([told_ready], [], [], START_S)
