"""The login of NAOqi 2.9: a user and a password. NAOqi 2.8 asks for none.

Source: `naoqi_api.yaml`, connection.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path

from hal.errors import BackendError

PASSWORD_VARIABLE = "NAOQI_PASSWORD"


@dataclass(frozen=True, slots=True)
class Login:
    """Who we are; the password never shows in a text."""

    user: str
    password: str = field(repr=False)


def find_login(user: str, password_file: str) -> Login | None:
    """The login, if there is a password: from a file, else from the environment.

    Raises BackendError when the file cannot be read or is empty.
    """
    if not password_file:
        password = os.environ.get(PASSWORD_VARIABLE, "")
        return Login(user, password) if password else None
    path = Path(password_file).expanduser()
    try:
        password = path.read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise BackendError(f"{path}: the password cannot be read: {error}") from None
    if not password:
        raise BackendError(f"{path}: the password is empty")
    return Login(user, password)
