"""Pictures from files, folders and videos, as the camera would give them."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from hal.yuyv import yuyv_from_rgb
from naod.errors import InputError

PICTURES = frozenset([".png", ".jpg", ".jpeg", ".bmp", ".ppm", ".pgm", ".webp", ".tif", ".tiff"])
VIDEOS = frozenset([".mp4", ".avi", ".mkv", ".mov", ".webm", ".mpg", ".mpeg", ".m4v", ".ogv"])


@dataclass(frozen=True, slots=True)
class Picture:
    """One picture.

    `source`: what a person calls it; `stem`: name of what is made from it. `yuyv`: (H, W, 2)
    uint8, W even: a picture of odd width has its last column twice. `width` is without it.
    """

    source: str
    stem: str
    yuyv: NDArray[np.uint8]
    width: int

    @property
    def height(self) -> int:
        """Rows."""
        return int(self.yuyv.shape[0])

    @property
    def padded_size(self) -> tuple[int, int]:
        """Width and height of `yuyv`."""
        return int(self.yuyv.shape[1]), self.height


def find_files(inputs: Sequence[str]) -> list[Path]:
    """Picture and video files; a folder stands for the pictures in it, by name.

    Raises InputError for what is not there, for an empty folder, and where two files would give
    the same name to what is made from them.
    """
    files: list[Path] = []
    for name in inputs:
        path = Path(name)
        if path.is_dir():
            inside = sorted(p for p in path.iterdir() if p.suffix.lower() in PICTURES)
            if not inside:
                raise InputError(f"{path}: no pictures in this folder")
            files += inside
        elif path.is_file():
            files.append(path)
        else:
            raise InputError(f"{path}: no such file or folder")
    stems: dict[str, Path] = {}
    for path in files:
        other = stems.setdefault(path.stem, path)
        if other is not path:
            raise InputError(f"{path}: has the same name as {other}, their results would mix")
    return files


def read_pictures(files: Sequence[Path]) -> Iterator[Picture]:
    """Every picture of the files, a video's one by one. Raises InputError for a corrupt one."""
    for path in files:
        if path.suffix.lower() in VIDEOS:
            yield from _read_video(path)
        else:
            yield _picture(str(path), path.stem, read_image(path, cv2.IMREAD_COLOR))


def read_image(path: Path, mode: int) -> NDArray[np.uint8]:
    """A picture as OpenCV reads it. Raises InputError with the decoder's reason, on one line."""
    try:
        data = np.frombuffer(path.read_bytes(), dtype=np.uint8)
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from None
    if not data.size:
        raise InputError(f"{path}: is empty")
    with _native_messages() as messages:
        try:
            image = cv2.imdecode(data, mode)
        except cv2.error as error:
            raise InputError(f"{path}: cannot be read as a picture: {error.err}") from None
    if image is None:
        reason = f" ({messages[-1]})" if messages else ""
        raise InputError(f"{path}: cannot be read as a picture{reason}")
    return np.asarray(image)


def _read_video(path: Path) -> Iterator[Picture]:
    with _native_messages():
        capture = cv2.VideoCapture(str(path))
    count = 0
    try:
        while True:
            with _native_messages():
                good, image = capture.read()
            if not good:
                break
            stem = f"{path.stem}_{count:06d}"
            yield _picture(str(path.with_name(stem)), stem, np.asarray(image, dtype=np.uint8))
            count += 1
    finally:
        capture.release()
    if not count:
        raise InputError(f"{path}: cannot be read as a video")


def _picture(source: str, stem: str, bgr: NDArray[np.uint8]) -> Picture:
    width = bgr.shape[1]
    if width % 2:
        bgr = np.concatenate([bgr, bgr[:, -1:]], axis=1)
    return Picture(source, stem, yuyv_from_rgb(bgr[..., ::-1]), width)


@contextmanager
def _native_messages() -> Iterator[list[str]]:
    """Keep what the decoders' C code prints on stderr; the list is filled at the end."""
    messages: list[str] = []
    with tempfile.TemporaryFile() as file:
        kept = os.dup(2)
        os.dup2(file.fileno(), 2)
        try:
            yield messages
        finally:
            os.dup2(kept, 2)
            os.close(kept)
            file.seek(0)
            text = file.read().decode(errors="replace")
            messages += [line.strip() for line in text.splitlines() if line.strip()]
