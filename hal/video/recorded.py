"""A video or a folder of pictures in the place of a camera, at a rate of frames by the clock.

A recording begins anew when it is over: a camera does not end, and the daemon may take a minute
to get ready. With `loop` off it ends, and reading it then raises CameraTimeoutError. Where it
begins anew, the stamps and the sequence go on.
"""

from __future__ import annotations

import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

from hal.errors import BackendError, CameraTimeoutError
from hal.health import Finding
from hal.protocols import Clock
from hal.types import CameraName, Frame
from hal.yuyv import yuyv_from_rgb

PICTURES = frozenset({".png", ".jpg", ".jpeg", ".bmp", ".ppm", ".pgm", ".tif", ".tiff"})
Image = NDArray[np.uint8]


class Reel(Protocol):
    """Numbered pictures; `length` of them. Raises BackendError for one that cannot be read."""

    length: int

    def image(self, number: int) -> Image:
        """Picture `number`, (H, W, 3) BGR."""
        ...


class PictureReel:
    """Picture files in the order of their names."""

    def __init__(self, files: Sequence[Path]) -> None:
        self._files = tuple(files)
        self.length = len(self._files)

    def image(self, number: int) -> Image:
        """Read a file. Raises BackendError."""
        path = self._files[number]
        image = cv2.imread(str(path), cv2.IMREAD_COLOR)
        if image is None:
            raise BackendError(f"{path}: not a picture that can be read")
        return np.asarray(image, dtype=np.uint8)


class VideoReel:
    """A video, decoded forwards; going back means beginning anew."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._open()
        self.length = self._count()
        if self.length < 1:
            raise BackendError(f"{path}: neither a video nor a picture that can be read")
        self._last: Image | None = None

    def image(self, number: int) -> Image:
        """Decode up to a frame. Raises BackendError."""
        if number < self._at:
            self._open()
        while self._at < number:
            self._video.grab()
            self._at += 1
        read, image = self._video.read()
        self._at += 1
        if not read:
            raise BackendError(f"{self._path}: frame {number} cannot be decoded")
        return np.asarray(image, dtype=np.uint8)

    def _open(self) -> None:
        self._video, self._at = cv2.VideoCapture(str(self._path)), 0

    def _count(self) -> int:
        """By decoding: the container's own number may be wrong."""
        count = 0
        while self._video.grab():
            count += 1
        self._open()
        return count


class RecordedCamera:
    """`VideoCamera` on a recording. A frame is decoded when somebody reads it."""

    def __init__(
        self,
        reel: Reel,
        name: CameraName,
        size: tuple[int, int],
        fps: float,
        clock: Clock,
        loop: bool = True,
    ) -> None:
        self._reel, self._clock, self._loop = reel, clock, loop
        self._name: CameraName = name
        self._size = size
        self._period_ns = 1e9 / fps
        self._start_ns = clock.now_ns()
        self._seen = -1
        self._last: Frame | None = None
        self._closed = False
        self._lock = threading.Lock()

    @property
    def name(self) -> CameraName:
        """Which camera it stands for."""
        return self._name

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return self._size

    def next(self, timeout_s: float) -> Frame:
        """The first frame from now on. Raises CameraTimeoutError."""
        return self._await(self._due(self._clock.now_ns() - 1) + 1, timeout_s)

    def unseen(self, timeout_s: float) -> Frame:
        """The newest frame not handed out before; waits. Raises CameraTimeoutError."""
        newest = self._newest()
        return self._await(max(newest, self._seen + 1), timeout_s)

    def latest(self, max_age_s: float) -> Frame | None:
        """The newest frame if it is not older than `max_age_s`, at once."""
        if self._closed:
            return None
        newest = self._newest()
        if not (self._clock.now_ns() - self._stamp_ns(newest)) / 1e9 <= max_age_s:
            return None
        try:
            return self._frame(newest)
        except CameraTimeoutError:
            return None

    def examine(self) -> list[Finding]:
        """What it is; see `hal.health.Examined`."""
        text = f"a recording of {self._reel.length} pictures, {1e9 / self._period_ns:g} a second"
        return [Finding("camera", "ok", text)]

    def close(self) -> None:
        """No more pictures. May be called twice."""
        self._closed = True

    def _due(self, now_ns: int) -> int:
        return int((now_ns - self._start_ns) // self._period_ns)

    def _newest(self) -> int:
        due = self._due(self._clock.now_ns())
        return due if self._loop else min(due, self._reel.length - 1)

    def _stamp_ns(self, number: int) -> int:
        return self._start_ns + -int(-number * self._period_ns // 1)

    def _await(self, number: int, timeout_s: float) -> Frame:
        limit_ns = self._clock.now_ns() + round(max(timeout_s, 0.0) * 1e9)
        ended = not self._loop and number >= self._reel.length
        if self._closed or ended or self._stamp_ns(number) > limit_ns:
            self._clock.sleep_until(limit_ns)
            over = "the recording is over" if ended else f"no picture within {timeout_s:g} s"
            raise CameraTimeoutError(over)
        self._clock.sleep_until(self._stamp_ns(number))
        return self._frame(number)

    def _frame(self, number: int) -> Frame:
        with self._lock:
            self._seen = max(self._seen, number)
            if self._last is None or self._last.sequence != number:
                try:
                    yuyv = self.yuyv(number % self._reel.length)
                except BackendError as error:
                    # one spoilt picture is a lost one
                    raise CameraTimeoutError(str(error)) from None
                self._last = Frame(self._stamp_ns(number), yuyv, self._name, 0.0, number)
            return self._last

    def yuyv(self, number: int) -> Image:
        """Picture `number` of the recording, (H, W, 2) uint8. Raises BackendError."""
        image = self._reel.image(number)
        height, width = image.shape[:2]
        if (width, height) != self._size:
            raise BackendError(
                f"picture {number} of the recording is {width}x{height}, the camera is configured "
                f"for {self._size[0]}x{self._size[1]}"
            )
        yuyv = yuyv_from_rgb(np.ascontiguousarray(image[..., ::-1]))
        yuyv.flags.writeable = False
        return yuyv


def open_recording(
    path: Path, which: CameraName, size: tuple[int, int], fps: float, clock: Clock, loop: bool
) -> RecordedCamera:
    """Open a folder, a picture or a video; looks at its first picture. Raises BackendError."""
    reel = _reel_of(path)
    camera = RecordedCamera(reel, which, size, fps, clock, loop)
    camera.yuyv(0)
    return camera


def _reel_of(path: Path) -> Reel:
    if path.is_dir():
        files = sorted(f for f in path.iterdir() if f.suffix.lower() in PICTURES and f.is_file())
        if not files:
            raise BackendError(f"{path}: a folder without pictures")
        return PictureReel(files)
    return PictureReel([path]) if path.suffix.lower() in PICTURES else VideoReel(path)
