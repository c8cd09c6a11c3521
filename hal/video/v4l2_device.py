"""One V4L2 device: format, controls, a stream of buffers. A thin layer on its ioctls."""

from __future__ import annotations

import errno
from dataclasses import dataclass
from struct import Struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hal.errors import BackendError
from hal.video import v4l2_abi as abi
from hal.video.v4l2_kernel import Kernel, Mapping

BUFFERS = 3
Row = tuple[Any, ...]
"""Fields of a structure as `v4l2_abi` lays them out: integers, and strings as bytes."""


@dataclass(frozen=True, slots=True)
class Control:
    """What a driver says of one of its controls."""

    number: int
    name: str
    low: int
    high: int
    step: int
    default: int
    writable: bool


@dataclass(frozen=True, slots=True)
class Shot:
    """A filled buffer, copied: YUYV (H, W, 2) uint8. `monotonic`: whether that clock timed it."""

    yuyv: NDArray[np.uint8]
    time_ns: int
    monotonic: bool
    sequence: int


class V4l2Device:
    """Raises OSError when the driver refuses, BackendError when it cannot do what we need."""

    def __init__(self, path: str, kernel: Kernel) -> None:
        self._kernel, self.path = kernel, path
        self._fd = kernel.open(path)
        self._mappings: list[Mapping] = []
        self._size, self._stride = (0, 0), 0
        self._streaming = False
        try:
            self.card = self._check()
        except BaseException:
            self.close()
            raise

    def set_format(self, size: tuple[int, int]) -> None:
        """YUYV of a size, in pixels. Raises BackendError with what it offers instead."""
        given = self._call(
            abi.S_FMT, abi.FORMAT, abi.CAPTURE, *size, abi.YUYV, abi.FIELD_NONE, *(0,) * 8
        )
        _, width, height, pixels, _, stride = given[:6]
        if pixels != abi.YUYV or (width, height) != size:
            raise BackendError(
                f"camera {self.path} ({self.card}) gives {abi.fourcc_text(pixels)} {width}x{height}"
                f" where YUYV {size[0]}x{size[1]} was asked for; it offers {self.offers()}"
            )
        self._size, self._stride = size, max(stride, 2 * width)

    def offers(self) -> str:
        """Its formats and, of YUYV, the sizes."""
        formats = [abi.fourcc_text(row[4]) for row in self._listed(abi.ENUM_FMT, abi.DESCRIPTION)]
        sizes = [
            f"{row[3]}x{row[4]}" if row[2] == abi.SIZE_DISCRETE else f"up to {row[4]}x{row[7]}"
            for row in self._listed(abi.ENUM_FRAMESIZES, abi.SIZES)
        ]
        return ", ".join(formats) + (f"; YUYV in {', '.join(sizes)}" if sizes else "")

    def set_rate(self, fps: int) -> float | None:
        """Ask for a rate; the one it will keep, None if it does not say."""
        try:
            given = self._call(abi.S_PARM, abi.PARM, abi.CAPTURE, 0, 0, 1, fps, 0, 0)
        except OSError:
            return None
        return given[4] / given[3] if given[3] else None

    def control(self, number: int) -> Control | None:
        """What it says of a control; None if it has none of the kind."""
        try:
            row = self._call(abi.QUERYCTRL, abi.QUERY, number, 0, b"", 0, 0, 0, 0, 0)
        except OSError as error:
            if error.errno in (errno.EINVAL, errno.ENOTTY):
                return None
            raise
        _, _, name, low, high, step, default, flags = row
        if flags & abi.CONTROL_DISABLED:
            return None
        writable = not flags & abi.CONTROL_READ_ONLY
        return Control(number, abi.text(name), low, high, step, default, writable)

    def value(self, number: int) -> int:
        """Present value of a control."""
        return int(self._call(abi.G_CTRL, abi.CONTROL, number, 0)[1])

    def set_value(self, number: int, value: int) -> None:
        """Set a control; whether it took is for `value` to say."""
        self._call(abi.S_CTRL, abi.CONTROL, number, value)

    def start(self) -> None:
        """Map buffers, hand them to the driver, let it fill them."""
        count = self._call(abi.REQBUFS, abi.REQUEST, BUFFERS, abi.CAPTURE, abi.MMAP, 0, 0)[0]
        for index in range(count):
            row = self._buffer(abi.QUERYBUF, index)
            self._mappings.append(self._kernel.map(self._fd, row[11], row[9]))
            self._buffer(abi.QBUF, index)
        self._call(abi.STREAMON, abi.NUMBER, abi.CAPTURE)
        self._streaming = True

    def read(self, timeout_s: float) -> Shot | None:
        """The newest filled buffer; older ones go back unread. None when none comes in time."""
        if not self._kernel.readable(self._fd, timeout_s):
            return None
        newest: Row | None = None
        while True:
            try:
                row = self._buffer(abi.DQBUF, 0)
            except BlockingIOError:
                break
            if newest is not None:
                self._buffer(abi.QBUF, newest[0])
            newest = row
        if newest is None:
            return None
        try:
            return self._shot(newest)
        finally:
            self._buffer(abi.QBUF, newest[0])

    def close(self) -> None:
        """Stop and let go. May be called twice."""
        fd, self._fd = self._fd, -1
        if fd < 0:
            return
        try:
            if self._streaming:
                argument = bytearray(abi.NUMBER.pack(abi.CAPTURE))
                self._kernel.ioctl(fd, abi.STREAMOFF, argument)
        except OSError:
            # it has been unplugged
            pass
        finally:
            for mapping in self._mappings:
                self._kernel.unmap(mapping)
            self._kernel.close(fd)

    def _shot(self, row: Row) -> Shot | None:
        index, _, used, flags, _, seconds, micros, sequence = row[:8]
        width, height = self._size
        if flags & abi.BUFFER_ERROR or used < self._stride * (height - 1) + 2 * width:
            return None
        rows = np.frombuffer(self._mappings[index], np.uint8, self._stride * height)
        picture = rows.reshape(height, self._stride)[:, : 2 * width].copy()
        monotonic = flags & abi.BUFFER_CLOCKS == abi.BUFFER_MONOTONIC
        time_ns = seconds * 1_000_000_000 + micros * 1000
        return Shot(picture.reshape(height, width, 2), time_ns, monotonic, sequence)

    def _check(self) -> str:
        _, card, _, _, capabilities, of_device = self._call(
            abi.QUERYCAP, abi.CAPABILITY, b"", b"", b"", 0, 0, 0
        )
        can = of_device if capabilities & abi.CAP_DEVICE_CAPS else capabilities
        if not (can & abi.CAP_CAPTURE and can & abi.CAP_STREAMING):
            raise BackendError(f"camera {self.path} ({abi.text(card)}) does not stream pictures")
        return abi.text(card)

    def _buffer(self, request: int, index: int) -> Row:
        rest = (0,) * 11
        row = (index, abi.CAPTURE, 0, 0, 0, 0, 0, 0, abi.MMAP, *rest[:5])
        return self._call(request, abi.BUFFER, *row)

    def _listed(self, request: int, layout: Struct) -> list[Row]:
        rows = []
        for index in range(32):
            of_format: Row = (index, abi.CAPTURE, 0, b"", 0, 0)
            of_size: Row = (index, abi.YUYV, *(0,) * 7)
            try:
                first = of_format if request == abi.ENUM_FMT else of_size
                rows.append(self._call(request, layout, *first))
            except OSError:
                break
        return rows

    def _call(self, request: int, layout: Struct, *values: int | bytes) -> Row:
        argument = bytearray(layout.pack(*values))
        self._kernel.ioctl(self._fd, request, argument)
        return layout.unpack(argument)
