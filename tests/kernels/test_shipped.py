"""The pack of the whole daemon, as a wheel carries it."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from instructions import beyond_sse, kernels_in

from hal.kernel_pack import PACK

SOURCES = Path(__file__).parents[2]
COUNT = """
from numba.core import event
from naod.kernels.rehearsal import rehearse_all

with event.install_recorder("numba:compile") as compiled:
    rehearse_all()
print(len(compiled.buffer))
"""


def run(root, cache, *arguments):
    environment = {k: v for k, v in os.environ.items() if not k.startswith("NUMBA")}
    environment |= {"NUMBA_CACHE_DIR": str(cache), "PYTHONPATH": str(root)}
    command = [sys.executable, "-P", *arguments]
    done = subprocess.run(
        command, env=environment, cwd=root, capture_output=True, text=True, check=True
    )
    return done.stdout


@pytest.fixture(scope="module")
def shipped(tmp_path_factory):
    """The packages with the kernels in them."""
    root = tmp_path_factory.mktemp("shipped")
    for package in ("hal", "naod"):
        shutil.copytree(
            SOURCES / package, root / package, ignore=shutil.ignore_patterns("__pycache__", "*.tar")
        )
    assert "kernels for silvermont" in run(root, root / "build", "-m", "naod.kernels.build")
    return root


@pytest.mark.slow
def test_nothing_is_compiled_after_installation(shipped, tmp_path):
    assert int(run(shipped, tmp_path, "-c", COUNT)) == 0


@pytest.mark.slow
def test_no_kernel_has_an_instruction_that_the_robot_lacks(shipped, tmp_path):
    subprocess.run(["tar", "xf", str(shipped / PACK), "-C", str(tmp_path)], check=True)
    kernels = list(kernels_in(tmp_path))
    assert len(kernels) > 20
    assert not set().union(*(beyond_sse(kernel) for kernel in kernels))
