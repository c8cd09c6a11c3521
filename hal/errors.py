"""Errors of the hardware abstraction layer; each carries the value that offended."""

from __future__ import annotations


class HalError(Exception):
    """Something between us and the robot went wrong."""


class BackendError(HalError):
    """A backend is unknown, not installed, or cannot be opened."""


class ScenarioError(HalError):
    """A scenario file is wrong; the text names the key."""


class MotionRefusedError(HalError):
    """A motion was refused at the robot; the text says why."""


class CameraTimeoutError(HalError):
    """No picture came in the time given."""
