"""Opening a camera by one string, whatever it is."""

from __future__ import annotations

import os
import stat
from collections.abc import Mapping
from pathlib import Path

from hal.errors import BackendError
from hal.protocols import Clock
from hal.types import CameraName
from hal.video.address import is_address
from hal.video.client import open_socket
from hal.video.recorded import open_recording
from hal.video.slot import VideoCamera
from hal.video.v4l2_camera import open_v4l2
from hal.video.v4l2_controls import ControlName

PATIENCE_S = 5.0
V6_DEVICES: dict[CameraName, str] = {"top": "/dev/video-top", "bottom": "/dev/video-bottom"}
"""Links that the V6's udev rules make (`nao_cameras.yaml`)."""


def open_camera(
    device: str,
    which: CameraName,
    size: tuple[int, int],
    fps: int,
    clock: Clock,
    *,
    patience_s: float = PATIENCE_S,
    loop: bool = True,
    upside_down: bool | None = None,
    controls: Mapping[ControlName, int] | None = None,
) -> VideoCamera:
    """Open a camera.

    `device`: a V4L2 path; the address of a frame socket (tcp://HOST:PORT, unix:PATH, or the path of
    a socket that is there); a video, a picture, or a folder of pictures; "" for the V6's own camera
    by V4L2. `clock` must count as CLOCK_MONOTONIC does, but for recordings, which go by any clock.
    `patience_s`: how long to wait for the first picture; 0 returns at once and lets it come when it
    comes. `loop`: whether a recording begins anew at its end. Of V4L2 only: `upside_down`, whether
    the sensor is (None: it is the top one), and `controls`, values in the driver's units to hold;
    without one, what the automatic has found is held. Raises BackendError with one line.
    """
    if is_address(device):
        return open_socket(device, which, size, clock, patience_s)
    path = device or V6_DEVICES[which]
    try:
        mode = os.stat(path).st_mode
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) else "not a path"
        raise BackendError(f"camera {path!r}: {why}") from None
    if stat.S_ISCHR(mode):
        turned = which == "top" if upside_down is None else upside_down
        return open_v4l2(path, which, size, fps, clock, turned, controls or {}, patience_s)
    if stat.S_ISDIR(mode) or stat.S_ISREG(mode):
        return open_recording(Path(path), which, size, fps, clock, loop)
    raise BackendError(f"camera {device!r}: neither a camera, a file, a folder nor a socket")
