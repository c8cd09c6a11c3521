"""Measurements between two that were made."""

from __future__ import annotations

from hal.types import BodyState


def state_between(a: BodyState, b: BodyState, share: float, stamp_ns: int) -> BodyState:
    """The measurement between two, interpolated."""
    rest = 1.0 - share
    return BodyState(
        stamp_ns=stamp_ns,
        angles_rad=rest * a.angles_rad + share * b.angles_rad,
        gyro_rad_s=rest * a.gyro_rad_s + share * b.gyro_rad_s,
        accel_m_s2=rest * a.accel_m_s2 + share * b.accel_m_s2,
        torso_roll_pitch_rad=rest * a.torso_roll_pitch_rad + share * b.torso_roll_pitch_rad,
        fsr_kg=rest * a.fsr_kg + share * b.fsr_kg,
        battery=rest * a.battery + share * b.battery,
        temperature_max_c=rest * a.temperature_max_c + share * b.temperature_max_c,
    )
