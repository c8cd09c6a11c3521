"""The body shortly before and after a picture, from which one sees how the camera moved."""

from __future__ import annotations

from hal.protocols import BodySensors
from hal.types import BodyState, Frame

ASIDE_NS = 20_000_000
"""To each side: over less, the steps of the encoders are most of what is seen."""


def around(sensors: BodySensors, frame: Frame) -> tuple[BodyState, BodyState] | None:
    """States at both ends of an exposure, or of 40 ms; the later is the newest where it must be.

    None where the body's past does not reach so far. Raises HalError.
    """
    aside_ns = max(round(0.5e9 * frame.exposure_s), ASIDE_NS)
    before = sensors.at(frame.stamp_ns - aside_ns)
    after = sensors.at(frame.stamp_ns + aside_ns) or sensors.latest()
    if before is None or after.stamp_ns <= frame.stamp_ns:
        return None
    return before, after
