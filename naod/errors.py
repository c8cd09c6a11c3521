"""Our errors. `InputError` is what a person can mend: one line, exit status 2."""

from __future__ import annotations


class NaodError(Exception):
    """Base of all errors this package raises on purpose."""


class InputError(NaodError):
    """A file, an argument or a message is wrong; the text is one line and names it."""
