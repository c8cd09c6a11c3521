"""A robot has numba but not scipy, from which numba takes the routines of linear algebra.

Kernels that used them were compiled here, where the benchmarks' libraries bring scipy, and ended
the daemon's process on the robot.
"""

from __future__ import annotations

import subprocess
import sys

LOOK = """
import sys
# whoever imports it is told that it is not installed
sys.modules["scipy"] = None
from hal.types import RobotInfo
from naod.config import DaemonConfig
from naod.daemon.warm_up import rehearse
from naod.kernels.rehearsal import SHAPES, standing
from naod.loop.equipment import Equipment

for shape in SHAPES:
    info = RobotInfo("nao", "v6", "none", simulated=False)
    equipment = Equipment.from_config(DaemonConfig(), info, shape, compare_paper=True)
    print(rehearse(equipment, standing()).pose is not None)
"""


def test_an_object_is_localised() -> None:
    done = subprocess.run(
        [sys.executable, "-c", LOOK], capture_output=True, text=True, timeout=600.0, check=False
    )
    assert done.returncode == 0, done.stderr[-2000:]
    assert done.stdout.split() == ["True", "True"]
