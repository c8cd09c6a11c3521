"""Where compiled kernels are kept: a folder of their own for each state of the sources.

numba renews a cached kernel when its own file changes, but not when a function it calls, in
another file, does: after an update it would go on running the old code. So the cache's folder
carries a digest of all files that hold kernels.

Kernels that came with the package (`hal.kernel_pack`) fill a folder that is not there yet.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
import time
from pathlib import Path

from hal.kernel_pack import read_manifest, unpack

_PACKAGES = ("naod", "sim_backend")
_KEPT_S = 30 * 24 * 3600.0


def use_own_cache() -> None:
    """Point numba to the folder; to be called before any kernel is defined.

    The folder lies in `NUMBA_CACHE_DIR` if that is set, else in the user's cache. Where kernels
    were shipped, numba is told to take the machine for the one they were made for, unless
    `NUMBA_CPU_NAME` says otherwise.
    """
    root = Path(__file__).parent.parent
    given = os.environ.get("NUMBA_CACHE_DIR")
    base = Path(given) if given else _user_cache() / "naod"
    if base.name.startswith("naod-"):
        # set by us, or by the process that started this one, which may be another checkout
        base = base.parent
    digest = source_digest(root)
    folder = base / f"naod-{digest}"
    manifest = read_manifest(root)
    if manifest is not None and manifest.digest == digest:
        os.environ.setdefault("NUMBA_CPU_NAME", manifest.cpu)
        os.environ.setdefault("NUMBA_CPU_FEATURES", "")
        if not folder.exists():
            unpack(root, folder)
    _remove_old(base, folder)
    os.environ["NUMBA_CACHE_DIR"] = str(folder)
    if "numba" in sys.modules:
        sys.modules["numba"].config.reload_config()


def source_digest(root: Path) -> str:
    """Digest of every source file in a folder that holds a kernel; constants lie beside them."""
    digest = hashlib.sha256()
    for package in _PACKAGES:
        texts = {path: path.read_bytes() for path in sorted((root / package).rglob("*.py"))}
        with_kernels = {path.parent for path, text in texts.items() if b"@njit" in text}
        for path, text in texts.items():
            if path.parent in with_kernels:
                digest.update(path.name.encode() + b"\0" + text)
    return digest.hexdigest()[:12]


def _user_cache() -> Path:
    return Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser()


def _remove_old(base: Path, present: Path) -> None:
    """Folders of other states of the sources that nobody has used for a month."""
    for folder in base.glob("naod-*"):
        try:
            if folder != present and time.time() - folder.stat().st_mtime > _KEPT_S:
                shutil.rmtree(folder, ignore_errors=True)
        except OSError:
            continue
