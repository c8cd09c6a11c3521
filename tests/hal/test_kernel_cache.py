"""Compiled kernels belong to one state of the sources."""

import os
import time

import pytest

from hal.kernel_cache import source_digest, use_own_cache


@pytest.fixture
def tree(tmp_path):
    folder = tmp_path / "naod" / "maths"
    folder.mkdir(parents=True)
    (tmp_path / "naod" / "words.py").write_text("TEXT = 1\n")
    (folder / "kernel.py").write_text("from numba import njit\n@njit\ndef f(): return STEP\n")
    (folder / "constants.py").write_text("STEP = 1\n")
    return tmp_path


def test_a_changed_constant_beside_a_kernel_makes_another_folder(tree):
    """numba itself went on running the old code."""
    before = source_digest(tree)
    assert source_digest(tree) == before
    (tree / "naod" / "maths" / "constants.py").write_text("STEP = 2\n")
    assert source_digest(tree) != before


def test_what_has_no_kernels_near_it_changes_nothing(tree):
    before = source_digest(tree)
    (tree / "naod" / "words.py").write_text("TEXT = 2\n")
    assert source_digest(tree) == before


def test_the_folder_given_is_used_and_old_ones_go(tmp_path, monkeypatch):
    old, recent = tmp_path / "naod-old", tmp_path / "naod-recent"
    for folder in (old, recent):
        folder.mkdir()
    long_ago = time.time() - 60 * 24 * 3600
    os.utime(old, (long_ago, long_ago))
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    use_own_cache()
    chosen = os.environ["NUMBA_CACHE_DIR"]
    assert chosen.startswith(str(tmp_path / "naod-"))
    assert not old.exists()
    assert recent.exists()
    use_own_cache()
    assert os.environ["NUMBA_CACHE_DIR"] == chosen
