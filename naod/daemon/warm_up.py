"""Compiling before it matters: the whole step runs once on a picture we paint ourselves.

The first run of the kernels on a machine takes longer than the watchdog waits.
"""

from __future__ import annotations

import logging

import numpy as np
from numpy.typing import NDArray

from hal.errors import HalError
from hal.protocols import Robot
from hal.types import Frame
from naod.loop.equipment import Equipment
from naod.perception.colour_model import Region, learn

log = logging.getLogger(__name__)

_GREY, _RED = (120, 128, 128), (90, 100, 210)


FIRST_PICTURE_S = 5.0


def warm_up(equipment: Equipment, robot: Robot) -> None:
    """Take a picture, then learn and localise a painted object; nothing of it is kept.

    Raises HalError when the body does not answer; a camera that does not is the loop's affair.
    """
    try:
        robot.camera.unseen(FIRST_PICTURE_S)
    except HalError as error:
        log.warning("no first picture: %s", error)
    body = robot.body.latest()
    camera = equipment.camera
    width, height = camera.width // 10 * 2, camera.height // 4
    region = Region((camera.width - width) // 4 * 2, (camera.height - height) // 2, width, height)
    yuyv = _painted(camera.width, camera.height, region)
    frame = Frame(body.stamp_ns, yuyv, equipment.camera_name, 0.01, 0)
    equipment.sight(learn([yuyv, yuyv], region), frame, body)


def _painted(width: int, height: int, region: Region) -> NDArray[np.uint8]:
    """A red rectangle on grey, with a little noise; (height, width, 2) YUYV."""
    rng = np.random.default_rng(0)
    yuyv = np.empty((height, width, 2), dtype=np.uint8)
    columns = slice(region.x, region.x + region.width)
    rows = slice(region.y, region.y + region.height)
    for place, (y, u, v) in (((slice(None), slice(None)), _GREY), ((rows, columns), _RED)):
        yuyv[(*place, 0)] = y
        yuyv[(*place, 1)][:, 0::2] = u
        yuyv[(*place, 1)][:, 1::2] = v
    noise = rng.integers(-3, 4, size=yuyv.shape, dtype=np.int16)
    return (yuyv.astype(np.int16) + noise).astype(np.uint8)
