"""Files in and out: TOML read into typed structs with errors that name key and line; whole writes.

A file is written beside its place and moved there, so it is there whole or not at all.
"""

from __future__ import annotations

import math
import os
import re
import tempfile
from pathlib import Path
from typing import TypeVar

import msgspec

from naod.errors import InputError

T = TypeVar("T")


def read_text(path: Path) -> str:
    """The text of a file. Raises InputError."""
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except IsADirectoryError:
        raise InputError(f"{path}: is a folder, not a file") from None
    except UnicodeDecodeError:
        raise InputError(f"{path}: is not UTF-8 text") from None
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from None


def read_toml(path: Path, kind: type[T]) -> T:
    """A TOML file as `kind`. Raises InputError with file, line and key."""
    return parse_toml(read_text(path), kind, str(path))


def parse_toml(text: str, kind: type[T], source: str) -> T:
    """TOML text as `kind`. Raises InputError with source, line and key."""
    try:
        tree = msgspec.toml.decode(text)
    except msgspec.DecodeError as error:
        raise InputError(f"{source}: not valid TOML: {_one_line(str(error))}") from None
    odd = _not_finite(tree, ())
    if odd is not None:
        line = _line_of(text, list(odd))
        raise InputError(f"{source}:{line or 1}: {'.'.join(odd)}: is not a finite number")
    try:
        return msgspec.convert(tree, kind)
    except msgspec.ValidationError as error:
        raise InputError(_explain(text, str(error), source)) from None


def _not_finite(tree: object, path: tuple[str, ...]) -> tuple[str, ...] | None:
    """Path of the first number that is NaN or infinite; TOML can write both, we can use neither."""
    if isinstance(tree, float) and not math.isfinite(tree):
        return path
    if isinstance(tree, dict):
        found = (_not_finite(value, (*path, key)) for key, value in tree.items())
    elif isinstance(tree, list):
        found = (_not_finite(value, path) for value in tree)
    else:
        return None
    return next((odd for odd in found if odd is not None), None)


def write_whole(path: Path, data: bytes | str, mode: int = 0o644) -> None:
    """Write a file whole or not at all. Raises InputError when the place cannot be written."""
    content = data.encode() if isinstance(data, str) else data
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(content)
                file.flush()
                os.fsync(file.fileno())
            os.chmod(temporary, mode)
            os.replace(temporary, path)
        except BaseException:
            Path(temporary).unlink(missing_ok=True)
            raise
    except OSError as error:
        raise InputError(f"{path}: cannot write: {error.strerror}") from None


def write_toml(path: Path, value: object) -> None:
    """Write a struct as TOML, whole or not at all."""
    write_whole(path, _toml_text(value))


def _toml_text(value: object) -> str:
    tree = msgspec.to_builtins(value)
    scalars = {k: v for k, v in tree.items() if v is not None and not isinstance(v, dict)}
    lines = [f"{key} = {_toml_value(item)}" for key, item in scalars.items()]
    for section, content in tree.items():
        if isinstance(content, dict):
            lines += ["", f"[{section}]"]
            lines += [f"{k} = {_toml_value(v)}" for k, v in content.items() if v is not None]
    return "\n".join(lines).lstrip() + "\n"


def _toml_value(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml_value(v) for v in value) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{k} = {_toml_value(v)}" for k, v in value.items()) + "}"
    if isinstance(value, str):
        return msgspec.json.encode(value).decode()
    return repr(value)


def _explain(text: str, message: str, source: str) -> str:
    reason, _, where = _one_line(message).partition(" - at `")
    keys = re.findall(r"[A-Za-z_][A-Za-z0-9_-]*", where)
    unknown = re.search(r"unknown field `([^`]+)`", reason)
    if unknown:
        keys.append(unknown.group(1))
    missing = re.search(r"missing required field `([^`]+)`", reason)
    if missing:
        dotted, reason = ".".join([*keys, missing.group(1)]), "is missing"
    else:
        dotted = ".".join(keys) or "the file"
    line = _line_of(text, keys)
    place = f"{source}:{line}" if line else source
    return f"{place}: {dotted}: {reason}"


def _line_of(text: str, keys: list[str]) -> int | None:
    """Line of a dotted key in TOML text: its assignment, or else its section's header."""
    section: list[str] = []
    best: int | None = None
    for number, line in enumerate(text.splitlines(), start=1):
        stripped = line.strip()
        header = re.match(r"\[\[?\s*([^\]]+?)\s*\]", stripped)
        if header and "=" not in stripped.split("]")[0]:
            section = [part.strip().strip("\"'") for part in header.group(1).split(".")]
            if section == keys:
                return number
            if section == keys[: len(section)] and best is None:
                best = number
            continue
        key = re.match(r"([A-Za-z0-9_\"'.-]+)\s*=", stripped)
        if key:
            path = section + [part.strip("\"'") for part in key.group(1).split(".")]
            if path == keys[: len(path)] and len(path) > len(section):
                return number
    return best


def _one_line(message: str) -> str:
    return " ".join(message.split())
