"""Build the pack of kernels that a wheel carries (`make wheels`).

A process of its own rehearses for the processor asked for, because numba knows only one processor
at a time; what it left in its cache is packed.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from hal.kernel_cache import source_digest
from hal.kernel_pack import MANIFEST, PACK, made_here, pack

CPU = "silvermont"
"""The V6's Atom E3845; like every x86-64 before 2011 it has no AVX. LLVM's name."""

REHEARSAL = "naod.kernels.rehearsal"


def build(root: Path, cpu: str = CPU, rehearsal: str = REHEARSAL) -> int:
    """Compile what a module needs when it is run, and pack it; returns the number of kernels.

    `root`: the folder of the packages. Raises OSError and subprocess.CalledProcessError.
    """
    for old in (PACK, MANIFEST):
        (root / old).unlink(missing_ok=True)
    with tempfile.TemporaryDirectory() as cache:
        digest = source_digest(root)
        subprocess.run([sys.executable, "-m", rehearsal], env=environment(cache, cpu), check=True)
        filled = Path(cache) / f"naod-{digest}"
        if not filled.is_dir():
            raise OSError("the sources were changed while they were compiled")
        return pack(root, filled, folders(root), made_here(digest, cpu))


def environment(cache: str, cpu: str) -> dict[str, str]:
    """Of a process that compiles for another processor into a cache of its own."""
    ours = {"NUMBA_CACHE_DIR": cache, "NUMBA_CPU_NAME": cpu, "NUMBA_CPU_FEATURES": ""}
    return {**os.environ, **ours}


def folders(root: Path) -> list[Path]:
    """Those below the package whose sources may hold kernels."""
    return sorted({path.parent for path in (root / "naod").rglob("*.py")})


def main() -> None:
    """Build for the robot, or for the processor named."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cpu", default=CPU, help=f"as LLVM names it; default: {CPU}")
    cpu = parser.parse_args().cpu
    count = build(Path(__file__).parents[2], cpu)
    print(f"{count} kernels for {cpu} in {PACK}")


if __name__ == "__main__":
    main()
