"""Kernels compiled beforehand, shipped as a file of the package.

numba files a kernel under a digest of the folder that its source lies in, which is another on
every machine: the pack names the folders as they are in the package. Beside it lies a manifest that
says which sources, Python, numba and processor it is for; for others it is as if it were not there.
"""

from __future__ import annotations

import json
import logging
import os
import shutil
import sys
import tarfile
import tempfile
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path, PurePosixPath

log = logging.getLogger(__name__)

PACK = PurePosixPath("naod/kernels.tar")
MANIFEST = PurePosixPath("naod/kernels.json")
_ENDINGS = (".nbi", ".nbc")


@dataclass(frozen=True, slots=True)
class Manifest:
    """What a pack is for: `digest` of the sources, `cpu` as LLVM names it, the versions."""

    digest: str
    cpu: str
    python: str
    numba: str


def made_here(digest: str, cpu: str) -> Manifest:
    """The manifest of a pack that this interpreter makes."""
    python = f"{sys.version_info.major}.{sys.version_info.minor}"
    return Manifest(digest, cpu, python, version("numba"))


def read_manifest(root: Path) -> Manifest | None:
    """The manifest of the pack that lies in the packages' folder, if it is for this interpreter."""
    try:
        found = Manifest(**json.loads((root / MANIFEST).read_text()))
    except FileNotFoundError:
        return None
    except (OSError, ValueError, TypeError) as error:
        log.warning("shipped kernels are not used: %s", error)
        return None
    if found != made_here(found.digest, found.cpu):
        log.warning("shipped kernels are for Python %s, numba %s", found.python, found.numba)
        return None
    return found


def pack(root: Path, cache: Path, folders: Iterable[Path], manifest: Manifest) -> int:
    """Write pack and manifest from a cache that was filled here; the number of kernels.

    `folders`: those of the sources, below `root`. Raises OSError.
    """
    target, count = root / PACK, 0
    with tempfile.NamedTemporaryFile(dir=target.parent, delete=False) as file:
        with tarfile.open(fileobj=file, mode="w") as tar:
            for folder in sorted(folders):
                name = PurePosixPath(folder.relative_to(root).as_posix())
                for path in sorted((cache / _subpath(folder)).glob("*")):
                    if path.suffix in _ENDINGS:
                        tar.add(path, arcname=str(name / path.name), filter=_anonymous)
                        count += path.suffix == ".nbc"
        os.chmod(file.name, 0o644)
    os.replace(file.name, target)
    (root / MANIFEST).write_text(json.dumps(asdict(manifest)) + "\n")
    return count


def unpack(root: Path, folder: Path) -> None:
    """Fill the cache's folder from the pack, whole or not at all; a failure is only logged."""
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        beside = Path(tempfile.mkdtemp(prefix=".unpacking-", dir=folder.parent))
    except OSError as error:
        log.warning("shipped kernels are not used: %s", error)
        return
    try:
        with tarfile.open(root / PACK) as tar:
            for member in tar:
                _unpack_one(tar, member, root, beside)
        beside.chmod(0o755)
        # somebody else may have been quicker: theirs is as good
        os.rename(beside, folder)
    except (OSError, tarfile.TarError) as error:
        if not folder.is_dir():
            log.warning("shipped kernels are not used: %s", error)
    finally:
        shutil.rmtree(beside, ignore_errors=True)


def _unpack_one(tar: tarfile.TarFile, member: tarfile.TarInfo, root: Path, into: Path) -> None:
    name = PurePosixPath(member.name)
    source = tar.extractfile(member)
    odd = ".." in name.parts or name.is_absolute() or name.suffix not in _ENDINGS
    if source is None or odd:
        raise tarfile.TarError(f"{member.name} does not belong into a pack")
    place = into / _subpath(root / name.parent)
    place.mkdir(parents=True, exist_ok=True)
    (place / name.name).write_bytes(source.read())


def _anonymous(member: tarfile.TarInfo) -> tarfile.TarInfo:
    member.uid = member.gid = member.mtime = 0
    member.uname = member.gname = ""
    return member


def _subpath(folder: Path) -> str:
    """Where numba keeps the kernels of the sources in a folder, below its cache."""
    from numba.core.caching import UserProvidedCacheLocator

    return str(UserProvidedCacheLocator.get_suitable_cache_subpath(str(folder / "source.py")))
