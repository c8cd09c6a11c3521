"""Messages to bytes and back, apart from any socket."""

from __future__ import annotations

import re
from typing import TypeVar

import msgspec

from naod.errors import NaodError
from naod.messages import FailureDetail, FailureReply, Message

T = TypeVar("T", bound=Message)

CONTROL_BYTES_MAX = 4096
"""No control message comes near this; a larger one is not even looked at."""

_NOT_FINITE = re.compile(rb"\b(nan|inf|infinity)\b", re.IGNORECASE)


class RefusedError(NaodError):
    """A message cannot be taken; the text is one line and says why."""


def encode(message: Message) -> bytes:
    """A message as JSON text."""
    return msgspec.json.encode(message)


def decode(payload: bytes, kind: type[T], limit: int = CONTROL_BYTES_MAX) -> T:
    """JSON text as a message. Raises RefusedError: oversized, malformed, unknown, not finite."""
    if len(payload) > limit:
        raise RefusedError(f"oversized: {len(payload)} bytes, at most {limit}")
    try:
        return msgspec.json.decode(payload, type=kind)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise RefusedError(_reason(payload, error)) from None


def failure(code: str, message: str) -> bytes:
    """The answer {ok: false, ...}."""
    return encode(FailureReply(error=FailureDetail(code=code, message=message)))


def _reason(payload: bytes, error: Exception) -> str:
    text = " ".join(str(error).split())
    if isinstance(error, msgspec.ValidationError):
        kind = "unknown" if "unknown field" in text else "invalid"
        return f"{kind}: {text}"[:200]
    if _NOT_FINITE.search(payload):
        return "a number that is not finite"
    return f"malformed: {text}"[:200]
