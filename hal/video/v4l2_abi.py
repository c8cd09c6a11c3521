"""V4L2's numbers and structures, as on a 64-bit Linux. Source: linux/videodev2.h, v4l2-controls.h.

No library does: linuxpy is GPL-3, and OpenCV neither lists controls nor gives their ranges, nor a
frame's sequence number.
"""

from __future__ import annotations

import struct

CAPTURE = 1
MMAP = 1
FIELD_NONE = 1
CAP_CAPTURE, CAP_STREAMING, CAP_DEVICE_CAPS = 0x1, 0x04000000, 0x80000000
BUFFER_ERROR, BUFFER_MONOTONIC, BUFFER_CLOCKS = 0x40, 0x2000, 0xE000
CONTROL_DISABLED, CONTROL_READ_ONLY, CONTROL_NEXT = 0x1, 0x4, 0x80000000
SIZE_DISCRETE = 1

CAPABILITY = struct.Struct("=16s32s32sIII12x")
FORMAT = struct.Struct("=I4xIIIIIIIIIIII152x")
"""type; width, height, pixelformat, field, bytesperline, sizeimage, and six more"""

DESCRIPTION = struct.Struct("=III32sII12x")
SIZES = struct.Struct("=III6I8x")
PARM = struct.Struct("=IIIIIII176x")
"""type; capability, capturemode, numerator, denominator, extendedmode, readbuffers"""

REQUEST = struct.Struct("=IIIII")
BUFFER = struct.Struct("=IIIII4xqq16xIIIIIIi4x")
"""index, type, bytesused, flags, field; seconds, microseconds; sequence, memory, offset, (high
half), length, ..., ..."""

QUERY = struct.Struct("=II32siiiiI8x")
"""id, type, name, minimum, maximum, step, default, flags"""

CONTROL = struct.Struct("=Ii")
NUMBER = struct.Struct("=i")


def _request(direction: int, number: int, size: int) -> int:
    return direction << 30 | size << 16 | ord("V") << 8 | number


_WRITE, _READ, _BOTH = 1, 2, 3
QUERYCAP = _request(_READ, 0, 104)
ENUM_FMT = _request(_BOTH, 2, 64)
G_FMT = _request(_BOTH, 4, 208)
S_FMT = _request(_BOTH, 5, 208)
REQBUFS = _request(_BOTH, 8, 20)
QUERYBUF = _request(_BOTH, 9, 88)
QBUF = _request(_BOTH, 15, 88)
DQBUF = _request(_BOTH, 17, 88)
STREAMON = _request(_WRITE, 18, 4)
STREAMOFF = _request(_WRITE, 19, 4)
G_PARM = _request(_BOTH, 21, 204)
S_PARM = _request(_BOTH, 22, 204)
G_CTRL = _request(_BOTH, 27, 8)
S_CTRL = _request(_BOTH, 28, 8)
QUERYCTRL = _request(_BOTH, 36, 68)
ENUM_FRAMESIZES = _request(_BOTH, 74, 44)

AUTO_WHITE_BALANCE = 0x0098090C
EXPOSURE = 0x00980911
AUTO_GAIN = 0x00980912
GAIN = 0x00980913
H_FLIP = 0x00980914
V_FLIP = 0x00980915
HUE_AUTO = 0x00980919
WHITE_BALANCE = 0x0098091A
EXPOSURE_AUTO = 0x009A0901
EXPOSURE_ABSOLUTE = 0x009A0902
EXPOSURE_AUTO_PRIORITY = 0x009A0903
FOCUS_ABSOLUTE = 0x009A090A
FOCUS_AUTO = 0x009A090C
EXPOSURE_MANUAL = 1


def fourcc(text: str) -> int:
    """The number of a pixel format."""
    return int.from_bytes(text.encode("ascii"), "little")


def fourcc_text(number: int) -> str:
    """The name of a pixel format."""
    return number.to_bytes(4, "little").decode("ascii", "replace").strip()


def text(raw: bytes) -> str:
    """A string that ends at the first zero."""
    return raw.split(b"\0")[0].decode("utf-8", "replace")


YUYV = fourcc("YUYV")
