"""Setting keys of [camera] in the text of a configuration file; all else stays as it was."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import msgspec

from naod.config import DaemonConfig
from naod.errors import InputError
from naod.files import parse_toml, read_text, write_whole

SECTION = "camera"
_HEADER = re.compile(r"^\s*\[\s*camera\s*\]\s*(#.*)?$")
_ANY_HEADER = re.compile(r"^\s*\[")


def write_camera(path: Path, lines: Mapping[str, str]) -> None:
    """Set keys of [camera] in a file, whole or not at all.

    Raises InputError where the file is written in a way that this cannot change, and leaves it.
    """
    text = read_text(path)
    before = parse_toml(text, DaemonConfig, str(path))
    changed = with_camera(text, lines)
    try:
        after = parse_toml(changed, DaemonConfig, str(path))
        wanted = parse_toml(with_camera("", lines), DaemonConfig, str(path)).camera
    except InputError:
        raise _cannot(path) from None
    given = {name: getattr(wanted, name) for name in lines}
    if after != msgspec.structs.replace(
        before, camera=msgspec.structs.replace(before.camera, **given)
    ):
        raise _cannot(path)
    target = path.resolve()
    write_whole(target, changed, mode=target.stat().st_mode & 0o777)


def with_camera(text: str, lines: Mapping[str, str]) -> str:
    """The text with these keys set in [camera]; a comment after a value stays."""
    rows = text.splitlines()
    start = next((n for n, row in enumerate(rows) if _HEADER.match(row)), None)
    if start is None:
        gap = [""] if rows and rows[-1].strip() else []
        return _joined([*rows, *gap, f"[{SECTION}]", *_rows_of(lines)])
    begin = start + 1
    ends = (n for n in range(begin, len(rows)) if _ANY_HEADER.match(rows[n]))
    end = next(ends, len(rows))
    section, missing = _replaced(rows[begin:end], dict(lines))
    last = len(section)
    while last > 0 and not section[last - 1].strip():
        last -= 1
    section[last:last] = _rows_of(missing)
    return _joined([*rows[:begin], *section, *rows[end:]])


def _replaced(rows: list[str], lines: dict[str, str]) -> tuple[list[str], dict[str, str]]:
    """The section's rows with what is there replaced, and what was not there."""
    out: list[str] = []
    number = 0
    while number < len(rows):
        row = rows[number]
        number += 1
        key = re.match(r"^(\s*)([A-Za-z0-9_-]+)(\s*=\s*)", row)
        if key is None or key.group(2) not in lines:
            out.append(row)
            continue
        value = row[key.end() :]
        # an array may go on over several lines
        while _open_brackets(value) > 0 and number < len(rows):
            value += "\n" + rows[number]
            number += 1
        comment = re.search(r"(\s*#[^\n]*)$", value)
        kept = comment.group(1) if comment else ""
        out.append(f"{key.group(0)}{lines.pop(key.group(2))}{kept}")
    return out, lines


def _open_brackets(value: str) -> int:
    bare = re.sub(r"#[^\n]*", "", value)
    return bare.count("[") - bare.count("]")


def _rows_of(lines: Mapping[str, str]) -> list[str]:
    return [f"{key} = {value}" for key, value in lines.items()]


def _joined(rows: list[str]) -> str:
    return "\n".join(rows).lstrip("\n") + "\n"


def _cannot(path: Path) -> InputError:
    return InputError(f"{path}: [camera] is written in a way that cannot be changed; paste it in")
