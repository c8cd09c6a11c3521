"""Values as `qi` can carry them.

`qi` 3.1.5 refuses numpy scalars, arrays and memory views, and sends bytes as a text of their Python
form (`naoqi_api.yaml`, bytes_pitfall). So arguments are made plain before they are handed over.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

Plain = bool | int | float | str | None | list["Plain"] | dict[str, "Plain"]


def plain(value: object) -> Plain:
    """The same value as `qi` takes it. Raises TypeError for what it would spoil."""
    if value is None or type(value) in (bool, int, float, str):
        return value  # type: ignore[return-value]
    if isinstance(value, bytes | bytearray | memoryview):
        raise TypeError("qi would send bytes as a text of their Python form")
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    # numpy's scalars and arrays, without importing numpy here
    to_list: Any = getattr(value, "tolist", None)
    if to_list is not None:
        return plain(to_list())
    # subclasses, such as enumerations
    for kind in (bool, int, float, str):
        if isinstance(value, kind):
            return kind(value)
    raise TypeError(f"qi cannot carry a {type(value).__name__}")
