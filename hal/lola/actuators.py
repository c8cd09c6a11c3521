"""LoLA's actuator message: always all eleven fields, each at full length, 786 bytes.

Source: `lola_protocol.yaml`, actuator_message: LoLA takes partial messages, but fills what an
array lacks with zeros, and zero is an angle.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hal.lola.layout import ACTUATOR_BYTES, ACTUATOR_FLOATS, to_lola

Array = NDArray[np.float64]

_FLOAT32 = 0xCA
_FALSE, _TRUE = 0xC2, 0xC3
_FIXARRAY_MAX = 15


def dark(length: int) -> Array:
    """Lights that are off."""
    return np.zeros(length)


@dataclass(frozen=True, slots=True)
class Lights:
    """0 to 1 each, orders as in `lola_protocol.yaml`; dark unless told otherwise."""

    chest: Array = field(default_factory=lambda: dark(3))
    left_ear: Array = field(default_factory=lambda: dark(10))
    right_ear: Array = field(default_factory=lambda: dark(10))
    left_eye: Array = field(default_factory=lambda: dark(24))
    right_eye: Array = field(default_factory=lambda: dark(24))
    left_foot: Array = field(default_factory=lambda: dark(3))
    right_foot: Array = field(default_factory=lambda: dark(3))
    skull: Array = field(default_factory=lambda: dark(12))


DARK = Lights()


@dataclass(frozen=True, slots=True)
class Actuators:
    """What the joints are to do: (26,) angles and stiffness, order of `JOINT_NAMES`.

    Stiffness 0 to 1, or -1 for a motor that is free.
    """

    angles_rad: Array
    stiffness: Array
    lights: Lights = DARK


def _template() -> tuple[bytes, list[slice]]:
    """The message with zeros for numbers, and where the numbers of each field lie.

    Every number takes five bytes, its type before it.
    """
    out = bytearray([0x80 | (len(ACTUATOR_FLOATS) + 1)])
    places = []
    for name, length in ACTUATOR_FLOATS.items():
        out += _key(name)
        out += (
            bytes([0x90 | length])
            if length <= _FIXARRAY_MAX
            else b"\xdc" + length.to_bytes(2, "big")
        )
        begin = len(out)
        out += bytes([_FLOAT32, 0, 0, 0, 0]) * length
        places.append(slice(begin, len(out)))
    out += _key("Sonar") + bytes([0x92, _FALSE, _FALSE])
    assert len(out) == ACTUATOR_BYTES
    return bytes(out), places


def _key(name: str) -> bytes:
    return bytes([0xA0 | len(name)]) + name.encode()


_TEMPLATE, _PLACES = _template()
_EMPTY = np.frombuffer(_TEMPLATE, dtype=np.uint8)
_NUMBERS = np.concatenate(
    [np.arange(place.start, place.stop).reshape(-1, 5)[:, 1:] for place in _PLACES]
)


def encode_actuators(actuators: Actuators, sonar: bool = False) -> bytes:
    """The message, 786 bytes; `sonar` turns both sides on.

    Raises ValueError when an array has the wrong length or holds a number that is not finite.
    """
    lights = actuators.lights
    if actuators.angles_rad.shape != (26,) or actuators.stiffness.shape != (26,):
        raise ValueError("angles and stiffness are of 26 joints")
    values = np.concatenate(
        [
            to_lola(actuators.angles_rad),
            to_lola(actuators.stiffness),
            lights.chest,
            lights.left_ear,
            lights.right_ear,
            lights.left_eye,
            lights.right_eye,
            lights.left_foot,
            lights.right_foot,
            lights.skull,
        ]
    )
    if not np.isfinite(values).all():
        raise ValueError("an actuator value is not finite")
    out = _EMPTY.copy()
    out[_NUMBERS] = values.astype(">f4").view(np.uint8).reshape(-1, 4)
    if sonar:
        out[-2:] = _TRUE
    return out.tobytes()
