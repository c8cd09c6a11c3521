"""Opening a camera by one string, whatever it is."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from hal.errors import BackendError
from hal.protocols import Clock
from hal.types import CameraName
from hal.video.address import is_address
from hal.video.client import open_socket
from hal.video.recorded import open_recording
from hal.video.slot import VideoCamera

PATIENCE_S = 5.0


def open_camera(
    device: str,
    which: CameraName,
    size: tuple[int, int],
    fps: int,
    clock: Clock,
    *,
    patience_s: float = PATIENCE_S,
    loop: bool = True,
) -> VideoCamera:
    """Open a camera.

    `device`: the address of a frame socket (tcp://HOST:PORT, unix:PATH, or the path of a socket
    that is there), a video, a picture, or a folder of pictures. `clock` must count as
    CLOCK_MONOTONIC does, but for recordings, which go by any clock. `patience_s`: how long to wait
    for a socket's first picture; 0 returns at once and lets it come when it comes. `loop`: whether
    a recording begins anew at its end. Raises BackendError with one line.
    """
    if is_address(device):
        return open_socket(device, which, size, clock, patience_s)
    try:
        mode = os.stat(device).st_mode
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) else "not a path"
        raise BackendError(f"camera {device!r}: {why}") from None
    if stat.S_ISDIR(mode) or stat.S_ISREG(mode):
        return open_recording(Path(device), which, size, fps, clock, loop)
    raise BackendError(f"camera {device!r}: neither a camera, a file, a folder nor a socket")
