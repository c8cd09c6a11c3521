"""The frame socket's bytes: a fixed header, then the picture. Nothing here knows of sockets.

A client asks for a picture with one byte, 0x01. The server answers with the next picture that this
client has not had: never an old one out of a queue. All numbers are little-endian.

    offset  type   what
    0       4 s    "NAOF"
    4       u8     1, the version of this format
    5       u8     camera: 0 top, 1 bottom
    6       u16    width in pixels, even
    8       u16    height in pixels
    10      u16    0
    12      u32    bytes that follow the header: width * height * 2
    16      i64    ns, the middle of the exposure, on the sender's CLOCK_MONOTONIC
    24      i64    ns, when this was sent, on the same clock
    32      i64    ns, the exposure's length; 0 if it is not known
    40      u64    sequence number of the picture
    48      16 s   which clock that is: the sender's boot id; zeros if it has none
    64             the picture, rows from the top: Y0 U Y1 V for each two pixels
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from hal.errors import HalError
from hal.types import CameraName, Frame

REQUEST = b"\x01"
MAGIC = b"NAOF"
VERSION = 1
SIDE_MAX = 4096
HEADER = struct.Struct("<4sBBHHHIqqqQ16s")
CAMERAS: tuple[CameraName, ...] = ("top", "bottom")
NO_CLOCK = bytes(16)
EXPOSURE_MAX_NS = 10_000_000_000

Fault = Literal["magic", "version", "camera", "size", "length", "time"]


class WireError(HalError):
    """What came is no picture of this format; `fault` says which field."""

    def __init__(self, fault: Fault, text: str) -> None:
        super().__init__(text)
        self.fault = fault


@dataclass(frozen=True, slots=True)
class Header:
    """All that is said of a picture; see the table above."""

    camera: CameraName
    width: int
    height: int
    stamp_ns: int
    sent_ns: int
    exposure_ns: int
    sequence: int
    clock_id: bytes

    @property
    def length(self) -> int:
        """Bytes of the picture."""
        return 2 * self.width * self.height


def packed(frame: Frame, sent_ns: int, clock_id: bytes) -> bytes:
    """The 64 bytes before a frame's picture. Raises WireError for a frame it cannot say."""
    height, width = frame.yuyv.shape[:2]
    _check_size(width, height)
    return HEADER.pack(
        MAGIC,
        VERSION,
        CAMERAS.index(frame.camera),
        width,
        height,
        0,
        2 * width * height,
        frame.stamp_ns,
        sent_ns,
        round(1e9 * frame.exposure_s),
        frame.sequence,
        clock_id,
    )


def unpacked(data: bytes) -> Header:
    """Read 64 bytes. Raises WireError."""
    magic, version, camera, width, height, _, length, *times, clock_id = HEADER.unpack(data)
    if magic != MAGIC:
        raise WireError("magic", f"begins with {magic!r}, not {MAGIC!r}: not a frame socket")
    if version != VERSION:
        raise WireError("version", f"speaks version {version} of the format, not {VERSION}")
    if camera >= len(CAMERAS):
        raise WireError("camera", f"camera number {camera} is neither 0 nor 1")
    _check_size(width, height)
    if length != 2 * width * height:
        raise WireError("length", f"{length} bytes for {width}x{height} YUYV pixels")
    stamp_ns, sent_ns, exposure_ns, sequence = times
    if not (0 <= stamp_ns <= sent_ns and 0 <= exposure_ns <= EXPOSURE_MAX_NS):
        raise WireError("time", f"exposed at {stamp_ns} for {exposure_ns}, sent at {sent_ns} ns")
    return Header(
        CAMERAS[camera], width, height, stamp_ns, sent_ns, exposure_ns, sequence, clock_id
    )


def frame_of(header: Header, picture: bytes | bytearray, offset_ns: int) -> Frame:
    """The frame; `offset_ns` is what its clock is behind ours. The array owns the bytes."""
    yuyv = np.frombuffer(picture, dtype=np.uint8).reshape(header.height, header.width, 2)
    yuyv.flags.writeable = False
    return Frame(
        stamp_ns=header.stamp_ns + offset_ns,
        yuyv=yuyv,
        camera=header.camera,
        exposure_s=header.exposure_ns / 1e9,
        sequence=header.sequence,
    )


def this_clock() -> bytes:
    """Which CLOCK_MONOTONIC is ours: the boot id, 16 bytes; zeros where there is none."""
    try:
        text = Path("/proc/sys/kernel/random/boot_id").read_text(encoding="ascii")
        return bytes.fromhex(text.strip().replace("-", "")).ljust(16, b"\0")[:16]
    except (OSError, ValueError):
        return NO_CLOCK


def _check_size(width: int, height: int) -> None:
    if not (0 < width <= SIDE_MAX and width % 2 == 0 and 0 < height <= SIDE_MAX):
        raise WireError("size", f"no picture is {width}x{height}")
