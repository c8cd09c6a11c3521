"""A robot has numba but not scipy, from which numba takes the routines of linear algebra.

Kernels that used them were compiled here, where the benchmarks' libraries bring scipy, and ended
the daemon's process on the robot.
"""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

NEED_IT = ("np.linalg", "np.dot", "np.vdot")

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


def kernels():
    """All compiled functions, with the file they are in."""
    for root in ("naod", "hal"):
        for path in sorted((Path(__file__).parents[2] / root).rglob("*.py")):
            for node in ast.walk(ast.parse(path.read_text())):
                if isinstance(node, ast.FunctionDef) and any(
                    "njit" in ast.unparse(decorator) for decorator in node.decorator_list
                ):
                    yield path.name, node


def test_no_kernel_asks_for_what_needs_it() -> None:
    """A kernel that was compiled before is kept, and then nobody notices above."""
    asks = [
        f"{name}, {kernel.name}: {ast.unparse(node)}"
        for name, kernel in kernels()
        for node in ast.walk(kernel)
        if (isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult))
        or (isinstance(node, ast.Attribute) and ast.unparse(node) in NEED_IT)
    ]
    assert asks == []
    assert sum(1 for _ in kernels()) > 100
