"""Kernels that were compiled beforehand are found, used, and hold nothing the robot can't run."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from instructions import beyond_sse, kernels_in

from hal.kernel_pack import MANIFEST, PACK, made_here, pack, read_manifest, unpack
from naod.kernels.build import CPU

SOURCES = Path(__file__).parents[2]
KERNEL = """
import numpy as np
from numba import njit

@njit(cache=True, nogil=True)
def total(values):
    out = 0.0
    for i in range(values.shape[0]):
        out += 2.0 * values[i]
    return out
"""
MAIN = """
from numba.core import event
import naod, naod.sums
import numpy as np

with event.install_recorder("numba:compile") as compiled:
    print(naod.sums.total(np.ones(64)), len(compiled.buffer))
"""


@pytest.fixture
def tree(tmp_path):
    """A package of one kernel that chooses its cache as ours does."""
    root = tmp_path / "here"
    package = root / "naod"
    package.mkdir(parents=True)
    shutil.copytree(SOURCES / "hal", root / "hal", ignore=shutil.ignore_patterns("__pycache__"))
    (package / "sums.py").write_text(KERNEL)
    (package / "main.py").write_text(MAIN)
    (package / "__init__.py").write_text(
        "from hal.kernel_cache import use_own_cache\nuse_own_cache()\n"
    )
    return root


def run(root, cache, **given):
    environment = {k: v for k, v in os.environ.items() if not k.startswith("NUMBA")}
    environment |= {"NUMBA_CACHE_DIR": str(cache), "PYTHONPATH": str(root), **given}
    done = subprocess.run(
        [sys.executable, "-P", "-m", "naod.main"],
        env=environment,
        cwd=root,
        capture_output=True,
        text=True,
        check=True,
    )
    value, compiled = done.stdout.split()
    assert float(value) == 128.0
    return int(compiled)


def packed(root, tmp_path):
    """Compile for the robot, pack."""
    compiled = run(root, tmp_path / "first", NUMBA_CPU_NAME=CPU, NUMBA_CPU_FEATURES="")
    assert compiled > 0
    (filled,) = (tmp_path / "first").glob("naod-*")
    digest = filled.name.removeprefix("naod-")
    return pack(root, filled, [root / "naod"], made_here(digest, CPU))


def test_a_package_with_its_kernels_compiles_nothing_wherever_it_lies(tree, tmp_path):
    assert packed(tree, tmp_path) == 1
    elsewhere = tree.rename(tmp_path / "elsewhere")
    assert run(elsewhere, tmp_path / "second") == 0
    assert run(elsewhere, tmp_path / "second") == 0


def test_kernels_of_other_sources_are_left_alone(tree, tmp_path):
    packed(tree, tmp_path)
    source = tree / "naod" / "sums.py"
    source.write_text(source.read_text().replace("2.0 * values[i]", "values[i] + values[i]"))
    assert run(tree, tmp_path / "second") > 0


def test_a_manifest_for_another_python_is_as_if_it_were_not_there(tmp_path):
    (tmp_path / "naod").mkdir()
    assert read_manifest(tmp_path) is None
    known = made_here("0", CPU)
    old = {"digest": "0", "cpu": CPU, "python": "2.7", "numba": "0"}
    for text in ("{", "[]", json.dumps({"digest": "0"}), json.dumps(old)):
        (tmp_path / MANIFEST).write_text(text)
        assert read_manifest(tmp_path) is None
    fields = {name: getattr(known, name) for name in ("digest", "cpu", "python", "numba")}
    (tmp_path / MANIFEST).write_text(json.dumps(fields))
    assert read_manifest(tmp_path) == known


def test_a_broken_pack_leaves_nothing_behind(tmp_path, caplog):
    (tmp_path / "naod").mkdir()
    (tmp_path / PACK).write_bytes(b"not a pack")
    unpack(tmp_path, tmp_path / "cache" / "naod-0")
    assert list((tmp_path / "cache").iterdir()) == []
    assert "not used" in caplog.text


def test_what_is_compiled_for_the_robot_has_no_avx(tree, tmp_path):
    packed(tree, tmp_path)
    ours = list(kernels_in(next((tmp_path / "first").glob("naod-*"))))
    assert ours
    assert not set().union(*(beyond_sse(kernel) for kernel in ours))


@pytest.mark.skipif("avx2" not in Path("/proc/cpuinfo").read_text(), reason="no AVX here to find")
def test_the_search_for_avx_finds_it_where_it_is(tree, tmp_path):
    run(tree, tmp_path / "host")
    ours = list(kernels_in(next((tmp_path / "host").glob("naod-*"))))
    assert set().union(*(beyond_sse(kernel) for kernel in ours))
