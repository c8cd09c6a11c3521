"""Ankle limits: the shell makes the roll's range depend on the pitch.

Source: `nao_kinematics.yaml`, ankle_roll_limits_by_ankle_pitch (NAOqi documentation).
"""

from __future__ import annotations

import numpy as np

# pitch, least roll, greatest roll of the left ankle; the right one's is its mirror image
_ROWS = (
    (-1.189442, -0.049916, 0.075049),
    (-0.840027, -0.179943, 0.169995),
    (-0.700051, -0.397935, 0.220086),
    (-0.449946, -0.397935, 0.768992),
    (0.100007, -0.397935, 0.768992),
    (0.349938, -0.397935, 0.550477),
    (0.922755, 0.0, 0.049916),
)
_PITCH = np.array([row[0] for row in _ROWS])
_ROLL_MIN = np.array([row[1] for row in _ROWS])
_ROLL_MAX = np.array([row[2] for row in _ROWS])


def left_roll_range_rad(pitch_rad: float) -> tuple[float, float]:
    """Least and greatest roll of the left ankle at a pitch, linear between the rows."""
    low = float(np.interp(pitch_rad, _PITCH, _ROLL_MIN))
    return low, float(np.interp(pitch_rad, _PITCH, _ROLL_MAX))


def right_roll_range_rad(pitch_rad: float) -> tuple[float, float]:
    """The same of the right ankle."""
    low, high = left_roll_range_rad(pitch_rad)
    return -high, -low
