"""The few system calls that V4L2 needs, so that a driver may be stood in for byte by byte."""

from __future__ import annotations

import fcntl
import mmap
import os
import select
from typing import Protocol

Mapping = memoryview | mmap.mmap


class Kernel(Protocol):
    """All of them raise OSError."""

    def open(self, path: str) -> int:
        """Open a device without blocking; its file descriptor."""
        ...

    def close(self, fd: int) -> None:
        """Close it."""
        ...

    def ioctl(self, fd: int, request: int, argument: bytearray) -> None:
        """Call it; the argument is changed in place."""
        ...

    def map(self, fd: int, length: int, offset: int) -> Mapping:
        """A buffer of the driver's, readable."""
        ...

    def unmap(self, mapping: Mapping) -> None:
        """Let go of a buffer."""
        ...

    def readable(self, fd: int, timeout_s: float) -> bool:
        """Wait until a buffer is filled; False when none is in time."""
        ...


class Linux:
    """The real ones."""

    def open(self, path: str) -> int:
        """Open a device without blocking."""
        return os.open(path, os.O_RDWR | os.O_NONBLOCK | os.O_CLOEXEC)

    def close(self, fd: int) -> None:
        """Close it."""
        os.close(fd)

    def ioctl(self, fd: int, request: int, argument: bytearray) -> None:
        """Call it; the argument is changed in place."""
        fcntl.ioctl(fd, request, argument, True)

    def map(self, fd: int, length: int, offset: int) -> Mapping:
        """A buffer of the driver's. What was mapped for writing too every driver accepts."""
        return mmap.mmap(fd, length, mmap.MAP_SHARED, offset=offset)

    def unmap(self, mapping: Mapping) -> None:
        """Let go of a buffer."""
        if isinstance(mapping, mmap.mmap):
            mapping.close()

    def readable(self, fd: int, timeout_s: float) -> bool:
        """Wait until a buffer is filled."""
        return bool(select.select([fd], [], [], timeout_s)[0])
