"""LoLA's messages from LoLA's side: sensor messages out, actuator messages in.

Source: `lola_protocol.yaml`, sensor_message and actuator_message. How LoLA itself tells where an
actuator message ends is not published; here it is where the MessagePack map ends, so that a client
may leave fields out.
"""

from __future__ import annotations

import struct
from typing import Annotated

import msgspec
import numpy as np
from msgspec import Meta
from numpy.typing import NDArray

from hal.errors import HalError

Array = NDArray[np.float64]
MESSAGE_MAX_BYTES = 4096

_Three = Annotated[list[float], Meta(min_length=3, max_length=3)]
_Ear = Annotated[list[float], Meta(min_length=10, max_length=10)]
_Eye = Annotated[list[float], Meta(min_length=24, max_length=24)]
_Skull = Annotated[list[float], Meta(min_length=12, max_length=12)]
_Joints = Annotated[list[float], Meta(min_length=25, max_length=25)]
_Sonar = Annotated[list[bool], Meta(min_length=2, max_length=2)]


class WireError(HalError):
    """Bytes that are no actuator message."""


class ActuatorMessage(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What a client sends; all fields are optional, arrays are whole."""

    Position: _Joints | None = None
    Stiffness: _Joints | None = None
    Chest: _Three | None = None
    LEar: _Ear | None = None
    REar: _Ear | None = None
    LEye: _Eye | None = None
    REye: _Eye | None = None
    LFoot: _Three | None = None
    RFoot: _Three | None = None
    Skull: _Skull | None = None
    Sonar: _Sonar | None = None


_DECODER = msgspec.msgpack.Decoder(ActuatorMessage)


def floats(name: str, values: Array | list[float]) -> bytes:
    """A key and its array of float32."""
    numbers = b"".join(b"\xca" + struct.pack(">f", value) for value in values)
    return _key(name) + _array(len(values)) + numbers


def integers(name: str, values: list[int]) -> bytes:
    """A key and its array of small positive integers."""
    return _key(name) + _array(len(values)) + bytes(values)


def strings(name: str, values: list[str]) -> bytes:
    """A key and its array of short texts."""
    return _key(name) + _array(len(values)) + b"".join(_key(value) for value in values)


def message(fields: list[bytes]) -> bytes:
    """A map of at most 15 fields."""
    return bytes([0x80 | len(fields)]) + b"".join(fields)


def _key(text: str) -> bytes:
    data = text.encode()
    return bytes([0xA0 | len(data)]) + data


def _array(length: int) -> bytes:
    return bytes([0x90 | length]) if length < 16 else b"\xdc" + struct.pack(">H", length)


class ActuatorStream:
    """Cuts a stream of bytes into messages."""

    def __init__(self) -> None:
        self._data = bytearray()

    def feed(self, data: bytes) -> list[ActuatorMessage]:
        """The messages that are whole now. Raises WireError, and is of no use after that."""
        self._data += data
        found = []
        while self._data:
            end = end_of(self._data)
            if end is None:
                if len(self._data) > MESSAGE_MAX_BYTES:
                    raise WireError(f"a message of more than {MESSAGE_MAX_BYTES} bytes")
                break
            found.append(_decoded(bytes(self._data[:end])))
            del self._data[:end]
        return found


def _decoded(data: bytes) -> ActuatorMessage:
    try:
        decoded = _DECODER.decode(data)
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise WireError(str(error)) from None
    for name in decoded.__struct_fields__:
        values = getattr(decoded, name)
        if values is not None and not np.isfinite(values).all():
            raise WireError(f"{name}: a number is not finite")
    return decoded


_FIXED = {0xC0: 0, 0xC2: 0, 0xC3: 0, 0xCA: 4, 0xCB: 8} | {
    kind: 1 << (kind & 3) for kind in range(0xCC, 0xD4)
}
_COUNTED = {0xD9: 1, 0xDA: 2, 0xDB: 4, 0xC4: 1, 0xC5: 2, 0xC6: 4}
_NESTED = {0xDC: (2, 1), 0xDD: (4, 1), 0xDE: (2, 2), 0xDF: (4, 2)}


def end_of(data: bytearray) -> int | None:
    """Where the first MessagePack value ends; None if it is not whole. Raises WireError."""
    at, due = 0, 1
    while due:
        if at >= len(data):
            return None
        kind = data[at]
        at += 1
        due -= 1
        if kind <= 0x7F or kind >= 0xE0:
            continue
        if kind <= 0x8F:
            due += 2 * (kind & 0x0F)
        elif kind <= 0x9F:
            due += kind & 0x0F
        elif kind <= 0xBF:
            at += kind & 0x1F
        elif kind in _FIXED:
            at += _FIXED[kind]
        elif kind in _COUNTED or kind in _NESTED:
            width = _COUNTED.get(kind) or _NESTED[kind][0]
            if at + width > len(data):
                return None
            count = int.from_bytes(data[at : at + width], "big")
            at += width + (count if kind in _COUNTED else 0)
            due += count * _NESTED[kind][1] if kind in _NESTED else 0
        else:
            raise WireError(f"byte {kind:#x} begins nothing")
        if at + due > MESSAGE_MAX_BYTES:
            raise WireError(f"a message of more than {MESSAGE_MAX_BYTES} bytes")
    return at if at <= len(data) else None
