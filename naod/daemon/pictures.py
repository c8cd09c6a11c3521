"""A frame as a JPEG, for people to look at."""

from __future__ import annotations

import cv2

from hal.types import Frame
from hal.yuyv import rgb_from_yuyv

QUALITY = 90


def jpeg_of(frame: Frame) -> bytes | None:
    """The frame as JPEG bytes; None if it cannot be encoded."""
    bgr = cv2.cvtColor(rgb_from_yuyv(frame.yuyv), cv2.COLOR_RGB2BGR)
    done, data = cv2.imencode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])
    return data.tobytes() if done else None
