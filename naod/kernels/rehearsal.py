"""Everything the daemon does with a picture, once: whatever it needs compiled is then compiled."""

from __future__ import annotations

import itertools

import msgspec
import numpy as np

from hal.nao.joints import JOINT_NAMES
from hal.types import BodyState, RobotInfo
from naod.config import DaemonConfig, SegmentationConfig
from naod.daemon.warm_up import rehearse
from naod.loop.equipment import Equipment
from naod.perception.learning import KINDS
from naod.pose.objects import Cylinder, ObjectShape, Rectangle

SHAPES: tuple[ObjectShape, ...] = (Cylinder(), Rectangle())
OPTIMISERS = ("exact", "icm")


def rehearse_all() -> None:
    """Both shapes, every kind of model, both optimisers, pictures that may be written and not."""
    body, info = standing(), RobotInfo("nao", "v6", "none", simulated=False)
    for shape, kind, optimiser in itertools.product(SHAPES, KINDS, OPTIMISERS):
        settings = msgspec.structs.replace(SegmentationConfig(), optimiser=optimiser)
        config = msgspec.structs.replace(DaemonConfig(), segmentation=settings)
        equipment = Equipment.from_config(config, info, shape, compare_paper=True)
        for writeable in (False, True):
            rehearse(equipment, body, writeable, kind)


def standing() -> BodyState:
    """A robot that stands straight on both feet."""
    zero = np.zeros(3)
    return BodyState(
        stamp_ns=0,
        angles_rad=np.zeros(len(JOINT_NAMES)),
        gyro_rad_s=zero,
        accel_m_s2=np.array([0.0, 0.0, 9.81]),
        torso_roll_pitch_rad=np.zeros(2),
        fsr_kg=np.full(8, 0.65),
        battery=1.0,
        temperature_max_c=30.0,
    )


if __name__ == "__main__":
    rehearse_all()
