"""What can go wrong between us and NAOqi."""

from __future__ import annotations

from hal.errors import HalError


class NotConnectedError(HalError):
    """There is no connection, or it was cut during the call."""


class NoAnswerError(HalError):
    """A call got no answer in its time; nobody knows whether it was carried out."""


class LoginError(HalError):
    """NAOqi does not accept the user and the password, or none was given."""


class ServiceMissingError(HalError):
    """This robot does not offer a service or a method of one."""


class CallRefusedError(HalError):
    """NAOqi answered a call with an error; the text is its own."""
