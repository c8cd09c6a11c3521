"""In a process of its own: kernels that a real look compiles although the rehearsal came first."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from numba.core.dispatcher import Dispatcher

from hal.backends import OpenOptions, open_robot
from naod.config import DaemonConfig
from naod.daemon.warm_up import warm_up
from naod.loop.equipment import Equipment
from naod.perception.colour_model import Region, learn
from naod.pose.objects import Cylinder


def compiled() -> dict[str, int]:
    """Number of compiled signatures by kernel."""
    counts = {}
    for name, module in list(sys.modules.items()):
        if name.startswith("naod."):
            for value in vars(module).values():
                if isinstance(value, Dispatcher):
                    counts[f"{value.__module__}.{value.__name__}"] = len(value.signatures)
    return counts


def main() -> None:
    section = {"scenario": None, "scenario_folder": Path(), "seed": 0, "real_time": False}
    robot = open_robot("sim", OpenOptions(section=section))
    equipment = Equipment.from_config(DaemonConfig(), robot.info, Cylinder())
    warm_up(equipment, robot)
    before = compiled()
    frame = robot.camera.next(1.0)
    rows, pairs = np.nonzero(frame.yuyv[:, 1::2, 1] > 180)
    region = Region(
        2 * int(pairs.min()) + 6,
        int(rows.min()) + 8,
        2 * int(np.ptp(pairs)) - 12,
        int(np.ptp(rows)) - 16,
    )
    body = robot.body.at(frame.stamp_ns)
    assert body is not None
    sighting = equipment.sight(learn([frame.yuyv], region), frame, body)
    assert sighting is not None
    assert sighting.look is not None
    robot.close()
    after = compiled()
    assert sum(before.values()) > 0
    for name in sorted(after):
        if after[name] != before.get(name, 0):
            print(name)


if __name__ == "__main__":
    main()
