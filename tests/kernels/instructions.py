"""Which instructions a cached kernel uses, by disassembling its object code."""

import pickletools
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest

ELF = b"\x7fELF"
MNEMONIC = re.compile(r"^\s*[0-9a-f]+:\s+(?:\(bad\)|([a-z]\w*))", re.MULTILINE)


def kernels_in(cache: Path):
    """Object code of every kernel below a folder."""
    for path in sorted(cache.rglob("*.nbc")):
        yield object_code(path.read_bytes())


def object_code(cached: bytes) -> bytes:
    """The object file inside a kernel as numba pickled it."""
    parts = (argument for _, argument, _ in pickletools.genops(cached))
    found = [part for part in parts if isinstance(part, bytes) and part.startswith(ELF)]
    assert len(found) == 1
    return found[0]


def beyond_sse(code: bytes) -> set[str]:
    """Mnemonics with a VEX or EVEX encoding: v-something, and the scalar ones of BMI."""
    objdump = shutil.which("objdump")
    if objdump is None:
        pytest.skip("objdump, of the C compiler's binutils, is not here")
    with tempfile.NamedTemporaryFile(suffix=".o") as file:
        file.write(code)
        file.flush()
        listing = subprocess.run(
            [objdump, "-d", "--no-show-raw-insn", file.name],
            capture_output=True,
            text=True,
            check=True,
        ).stdout
    mnemonics = set(MNEMONIC.findall(listing)) - {""}
    assert mnemonics
    bmi = {"andn", "bextr", "mulx", "pdep", "pext", "rorx", "sarx", "shlx", "shrx", "bzhi"}
    return {m for m in mnemonics if m.startswith("v") and m not in {"verr", "verw"}} | (
        mnemonics & bmi
    )
