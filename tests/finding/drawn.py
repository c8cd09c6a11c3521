"""Segmentations of known scenes, drawn: what the colour says is certain, only shapes differ."""

import cv2
import numpy as np

from naod.geometry.camera import nominal_camera
from naod.geometry.transforms import transform
from naod.perception.colour_model import ColourModel
from naod.perception.energy import STEPS
from naod.perception.segmenter import Segmentation
from naod.pose.contour import outline_px
from naod.pose.frames import facing

CAMERA = nominal_camera("v6", 640, 480)
SMALL = CAMERA.resized(160, 120)
SURE = 5 * STEPS

RED = (65.0, 106.0, 206.0)
MODEL = ColourModel(mean=RED, covariance=((9.0, 0.0, 0.0), (0.0, 9.0, 0.0), (0.0, 0.0, 9.0)))


def standing(x, y, z):
    """T_camera_object of an upright thing, seen level."""
    centre = np.array([x, y, z])
    return transform(facing(np.array([0.0, -1.0, 0.0]), centre), centre)


def draw(mask, shape, T):
    """Fill what a shape covers of a mask, 160x120."""
    outline = outline_px(shape, T, SMALL)
    fine = np.zeros((480, 640), np.uint8)
    cv2.fillPoly(fine, [np.rint((outline + 0.5) * 4.0 - 0.5).astype(np.int32)], 255)
    mask[cv2.resize(fine, (160, 120), interpolation=cv2.INTER_AREA) > 127] = 1
    return mask


def empty():
    return np.zeros((120, 160), np.uint8)


def segmented(mask):
    differences = np.where(mask > 0, np.int32(-SURE), np.int32(SURE))
    return Segmentation(mask, 0.0, 1, 4.0, (640, 480), True, differences)


def painted(mask, colour):
    """A picture (480, 640, 2) of one colour where a mask (120, 160) has something, else grey."""
    inside = np.kron(mask, np.ones((4, 4), np.uint8)) > 0
    yuyv = np.full((480, 640, 2), 128, np.uint8)
    y, u, v = np.rint(colour).astype(np.uint8)
    yuyv[..., 0][inside] = y
    yuyv[:, 0::2, 1][inside[:, 0::2]] = u
    yuyv[:, 1::2, 1][inside[:, 1::2]] = v
    return yuyv
