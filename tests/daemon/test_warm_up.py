"""The rehearsal before readiness reaches as far as the real thing."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import msgspec
import numpy as np
import pytest

from hal.nao.postures import posture
from hal.types import BodyState, RobotInfo
from naod.config import CameraConfig, DaemonConfig
from naod.daemon.warm_up import rehearse
from naod.loop.equipment import Equipment
from naod.pose.objects import Cylinder, ObjectShape, Rectangle


def standing() -> BodyState:
    zeros = np.zeros(3)
    return BodyState(
        stamp_ns=1,
        angles_rad=posture("StandInit"),
        gyro_rad_s=zeros,
        accel_m_s2=np.array([0.0, 0.0, 9.81]),
        torso_roll_pitch_rad=np.zeros(2),
        fsr_kg=np.full(8, 0.6),
        battery=1.0,
        temperature_max_c=38.0,
    )


@pytest.mark.parametrize("shape", [Cylinder(), Rectangle(), Rectangle(width_m=0.1, height_m=0.3)])
@pytest.mark.parametrize("size", [(320, 240), (640, 480)])
def test_painted_object_is_localised(shape: ObjectShape, size: tuple[int, int]) -> None:
    camera = CameraConfig(width=size[0], height=size[1])
    config = msgspec.structs.replace(DaemonConfig(), camera=camera)
    equipment = Equipment.from_config(config, RobotInfo("nao", "v6", "sim", True), shape)
    sighting = rehearse(equipment, standing())
    assert sighting is not None
    assert sighting.pose is not None
    assert sighting.look is not None
    # a quarter of the picture's height
    expected = equipment.camera.fy * shape.height_m / (size[1] / 4)
    seen = sighting.pose.T_camera_object[:3, 3]
    assert math.dist(seen, (0.0, 0.0, expected)) < 0.05 * expected


def test_first_real_look_compiles_nothing_more() -> None:
    """Pictures that may not be written to once had kernels compiled anew, for 3 s, after READY."""
    script = Path(__file__).with_name("rehearsal_script.py")
    done = subprocess.run(
        [sys.executable, str(script)], capture_output=True, text=True, timeout=300.0, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == []
