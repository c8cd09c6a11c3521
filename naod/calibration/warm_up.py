"""Compiling before the robot is opened: one that is not spoken to for long sits down."""

from __future__ import annotations

import cv2
import numpy as np

from hal.types import Frame
from hal.yuyv import yuyv_from_rgb
from naod.calibration.eyes import Eyes
from naod.config import DaemonConfig
from naod.geometry.camera import nominal_camera
from naod.perception.colour_model import Region, learn
from naod.pose.objects import Rectangle

_GREY, _YELLOW = (120, 120, 120), (220, 190, 30)
BLUR_PX, GRAIN = 0.8, 2.0


def warm_up(config: DaemonConfig) -> bool:
    """Learn and measure a painted rectangle; whether it was found. Nothing of it is kept."""
    width, height = config.camera.width, config.camera.height
    box = Region(width // 4, height // 3, width // 4, height // 3)
    rgb = np.full((height, width, 3), _GREY, dtype=np.float32)
    rgb[box.y : box.y + box.height, box.x : box.x + box.width] = _YELLOW
    grain = np.random.default_rng(0).normal(0.0, GRAIN, rgb.shape)
    yuyv = yuyv_from_rgb(np.asarray(cv2.GaussianBlur(rgb, (0, 0), BLUR_PX)) + grain)
    # as a camera's own pictures are: kernels are compiled anew for the other kind
    yuyv.flags.writeable = False
    inside = Region(box.x + 8, box.y + 8, box.width - 16, box.height - 16)
    shape = Rectangle(width_m=0.2, height_m=0.2 * box.height / box.width)
    camera = nominal_camera(config.robot.version, width, height)
    eyes = Eyes(config, learn([yuyv], inside), shape, camera)
    glimpse, _ = eyes.glimpse(Frame(0, yuyv, config.camera.which, 0.0, 0))
    return glimpse is not None
