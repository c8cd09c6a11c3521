"""A V4L2 driver in memory, behind the system calls: it sees and answers bytes.

Its offsets are those of linux/videodev2.h, written down here apart from `hal.video.v4l2_abi`.
"""

import errno
import struct
import threading
import time

import numpy as np

YUYV, MJPG = b"YUYV", b"MJPG"
EXPOSURE_AUTO, EXPOSURE_ABSOLUTE, GAIN = 0x9A0901, 0x9A0902, 0x980913
AUTO_WB, WB, FOCUS_AUTO, FOCUS = 0x98090C, 0x98091A, 0x9A090C, 0x9A090A
H_FLIP, V_FLIP = 0x980914, 0x980915


def u32(argument, offset):
    return struct.unpack_from("<I", argument, offset)[0]


def put(argument, offset, *values):
    struct.pack_into(f"<{len(values)}I", argument, offset, *values)


class Driver:
    """`controls`: number to [low, high, value]; `stubborn` ones stay, `dead` ones fail."""

    def __init__(self, controls=(), sizes=((640, 480), (8, 4)), stride=None, pixels=YUYV):
        self.controls = {number: list(row) for number, row in dict(controls).items()}
        self.stubborn, self.dead, self.written = set(), set(), []
        self.sizes, self.stride, self.pixels = sizes, stride, pixels
        self.opened = self.closed = 0
        self.streaming = self.gone = False
        self.buffers, self.queued, self.filled = [], [], []
        self.changed = threading.Condition()

    def open(self, path):
        if self.gone:
            raise OSError(errno.ENODEV, "No such device")
        self.opened += 1
        return 40 + self.opened

    def close(self, fd):
        self.closed += 1

    def map(self, fd, length, offset):
        return memoryview(self.buffers[offset // 4096])[:length]

    def unmap(self, mapping):
        mapping.release()

    def readable(self, fd, timeout_s):
        with self.changed:
            return self.changed.wait_for(lambda: self.filled or self.gone, timeout_s)

    def ioctl(self, fd, request, argument):
        assert len(argument) == request >> 16 & 0x3FFF
        if self.gone:
            raise OSError(errno.ENODEV, "No such device")
        names = {0: "cap", 2: "format_at", 5: "format", 8: "request", 9: "query", 15: "queue",
                 17: "dequeue", 18: "on", 19: "off", 22: "parm", 27: "get", 28: "set",
                 36: "control", 74: "size_at"}  # fmt: skip
        with self.changed:
            getattr(self, "_" + names[request & 0xFF])(argument)

    def fill(self, picture, time_ns=None, flags=0x2000, sequence=0):
        """A picture has been taken: it goes to the first buffer that is free."""
        with self.changed:
            assert self.changed.wait_for(lambda: self.queued and self.streaming, 5.0)
            index = self.queued.pop(0)
            height, width = picture.shape[:2]
            stride = self.stride or 2 * width
            rows = np.frombuffer(self.buffers[index], np.uint8)[: stride * height]
            rows.reshape(height, stride)[:, : 2 * width] = picture.reshape(height, -1)
            at = time.monotonic_ns() if time_ns is None else time_ns
            self.filled.append((index, stride * height, flags, at, sequence))
            self.changed.notify_all()

    def unplug(self):
        with self.changed:
            self.gone = True
            self.changed.notify_all()

    def plug_in(self):
        self.buffers, self.queued, self.filled, self.streaming = [], [], [], False
        self.gone = False

    def _cap(self, argument):
        argument[16:26] = b"Sham video"
        put(argument, 84, 0x84200001, 0x04200001)

    def _format_at(self, argument):
        kinds = (YUYV, MJPG)
        if u32(argument, 0) >= 2:
            raise OSError(errno.EINVAL, "Invalid argument")
        argument[44:48] = kinds[u32(argument, 0)]

    def _size_at(self, argument):
        if u32(argument, 0) >= len(self.sizes):
            raise OSError(errno.EINVAL, "Invalid argument")
        put(argument, 8, 1, *self.sizes[u32(argument, 0)])

    def _format(self, argument):
        size = u32(argument, 8), u32(argument, 12)
        width, height = size if size in self.sizes else self.sizes[0]
        stride = self.stride or 2 * width
        put(argument, 8, width, height)
        argument[16:20] = self.pixels
        put(argument, 24, stride, stride * height)
        self.bytes = stride * height

    def _parm(self, argument):
        put(argument, 12, 1, 30)

    def _request(self, argument):
        self.buffers = [bytearray(self.bytes) for _ in range(u32(argument, 0))]

    def _query(self, argument):
        put(argument, 64, 4096 * u32(argument, 0))
        put(argument, 72, self.bytes)

    def _queue(self, argument):
        self.queued.append(u32(argument, 0))
        self.changed.notify_all()

    def _dequeue(self, argument):
        if not self.filled:
            raise BlockingIOError(errno.EAGAIN, "Resource temporarily unavailable")
        index, used, flags, at, sequence = self.filled.pop(0)
        put(argument, 0, index, 1, used, flags)
        struct.pack_into("<qq", argument, 24, at // 10**9, at % 10**9 // 1000)
        put(argument, 56, sequence)

    def _on(self, argument):
        self.streaming = True
        self.changed.notify_all()

    def _off(self, argument):
        self.streaming = False

    def _control(self, argument):
        number = u32(argument, 0)
        if number not in self.controls:
            raise OSError(errno.EINVAL, "Invalid argument")
        low, high, value = self.controls[number]
        struct.pack_into("<iiii", argument, 40, low, high, 1, value)

    def _get(self, argument):
        put(argument, 4, self.controls[u32(argument, 0)][2])

    def _set(self, argument):
        number, value = struct.unpack("<Ii", argument)
        self.written.append((number, value))
        if number in self.dead:
            raise OSError(errno.EIO, "Input/output error")
        if number not in self.stubborn:
            self.controls[number][2] = value
