"""What getImageRemote returns, as a picture.

Source: `naoqi_api.yaml`, image_layout and qi_python_3_1_5_findings: list or tuple; the pixels as
bytearray, bytes, or as a text, when the sender did not declare them raw.
"""

from __future__ import annotations

import ast
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hal.errors import HalError
from hal.naoqi.ids import BYTES_PER_PIXEL, YUV422


class PictureError(HalError):
    """What came is not the picture that was asked for."""


@dataclass(frozen=True, slots=True)
class Picture:
    """`yuyv` (height, width, 2) uint8, read only; `stamp_ns` is of the robot's clock."""

    yuyv: NDArray[np.uint8]
    stamp_ns: int


def picture_from(result: object, width: int, height: int) -> Picture | None:
    """The picture, or None if there is none yet. Raises PictureError."""
    if result is None or (isinstance(result, list | tuple) and not result):
        return None
    if not isinstance(result, list | tuple) or len(result) < 7:
        raise PictureError(f"a picture is a list of 12, not {_shown(result)}")
    try:
        had = tuple(int(value) for value in result[:4])
        seconds, micros = int(result[4]), int(result[5])
    except (TypeError, ValueError):
        raise PictureError(f"a picture's head is not numbers: {_shown(result[:6])}") from None
    if had[:2] == (0, 0):
        return None
    if had != (width, height, BYTES_PER_PIXEL, YUV422):
        raise PictureError(
            f"asked for {width}x{height} in YUV422, got {had[0]}x{had[1]}, {had[2]} layers, "
            f"colour space {had[3]}"
        )
    data = bytes_from(result[6], width * height * BYTES_PER_PIXEL)
    yuyv = np.frombuffer(data, dtype=np.uint8).reshape(height, width, BYTES_PER_PIXEL)
    return Picture(yuyv, seconds * 1_000_000_000 + micros * 1000)


def bytes_from(data: object, size: int) -> bytes:
    """The pixels, whatever they came as. Raises PictureError when they are not `size` bytes."""
    if isinstance(data, bytes | bytearray):
        found: bytes | None = bytes(data)
    elif isinstance(data, str):
        found = _bytes_from_text(data, size)
    else:
        found = None
    if found is None or len(found) != size:
        length = "" if found is None else f" of {len(found)} bytes"
        raise PictureError(f"the pixels came as {type(data).__name__}{length}, not {size} bytes")
    return found


def _bytes_from_text(text: str, size: int) -> bytes | None:
    """Bytes that were sent as a text: as UTF-8 if they were valid, else as their Python form."""
    encoded = text.encode("utf-8", "surrogateescape")
    if len(encoded) == size:
        return encoded
    literal = text.removeprefix("bytearray(").removesuffix(")")
    if not literal.startswith(("b'", 'b"')):
        return None
    try:
        found = ast.literal_eval(literal)
    except (ValueError, SyntaxError):
        return None
    return found if isinstance(found, bytes) else None


def _shown(value: object) -> str:
    return repr(value)[:60]
