"""What was there before us, kept in the robot's own memory until it is put back.

A daemon that is killed cannot put anything back; the next one finds here what there was. The memory
is gone when NAOqi restarts, and then so are the changes.
"""

from __future__ import annotations

import json
from typing import Any

from hal.naoqi.errors import CallRefusedError, ServiceMissingError
from hal.naoqi.session import Session


def kept(session: Session, key: str) -> dict[str, Any] | None:
    """What is kept under a key; None if nothing is, or nothing of ours. Raises HalError."""
    try:
        text = session.call("ALMemory", "getData", key)
    except (CallRefusedError, ServiceMissingError):
        return None
    try:
        found = json.loads(text) if isinstance(text, str) and text else None
    except ValueError:
        return None
    return found if isinstance(found, dict) else None


def keep(session: Session, key: str, value: dict[str, Any]) -> None:
    """Keep it. A robot whose memory refuses is met too: then it is kept only here."""
    _write(session, key, json.dumps(value))


def forget(session: Session, key: str) -> None:
    """It has been put back."""
    _write(session, key, "")


def _write(session: Session, key: str, text: str) -> None:
    try:
        session.call("ALMemory", "insertData", key, text)
    except (CallRefusedError, ServiceMissingError):
        return
