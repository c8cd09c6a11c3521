"""The estop's memory: a file, so that a restart does not let go of it (S5)."""

from __future__ import annotations

import os
from pathlib import Path

from naod.errors import InputError
from naod.files import write_whole


class EstopLatch:
    """The latch is set while the file is there, whatever is in it."""

    def __init__(self, folder: Path) -> None:
        self.path = folder / "estop"

    def is_set(self) -> bool:
        """Whether the latch is set; also when that cannot be found out."""
        try:
            self.path.lstat()
        except (FileNotFoundError, NotADirectoryError):
            return False
        except OSError:
            return True
        return True

    def set(self) -> None:
        """Set it. Raises InputError when it cannot be kept."""
        write_whole(self.path, "latched until `naod ctl release`\n")
        self._settle()

    def clear(self) -> None:
        """Let go of it. Raises InputError when the file cannot be removed."""
        try:
            self.path.unlink(missing_ok=True)
        except OSError as error:
            raise InputError(f"{self.path}: cannot remove: {error.strerror}") from None
        self._settle()

    def _settle(self) -> None:
        """Make the folder's entry itself durable: a cut of power must not undo it."""
        try:
            folder = os.open(self.path.parent, os.O_RDONLY | os.O_DIRECTORY)
        except FileNotFoundError:
            return
        try:
            os.fsync(folder)
        finally:
            os.close(folder)
