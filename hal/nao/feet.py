"""Soles and force sensors. Source: `nao_kinematics.yaml`, fixed_frames and foot_sole."""

from __future__ import annotations

from hal.nao.joints import Vector3

SOLE_IN_ANKLE_M: Vector3 = (0.0, 0.0, -0.04511)
"""Floor under the ankle-roll axis, in the foot link (URDF; the documentation has 45.19 mm)."""

FSR_IN_ANKLE_M: dict[str, tuple[Vector3, Vector3, Vector3, Vector3]] = {
    "l_ankle": (
        (0.07025, 0.0299, -0.04511),
        (0.07025, -0.0231, -0.04511),
        (-0.03025, 0.0299, -0.04511),
        (-0.02965, -0.0191, -0.04511),
    ),
    "r_ankle": (
        (0.07025, 0.0231, -0.04511),
        (0.07025, -0.0299, -0.04511),
        (-0.03025, 0.0191, -0.04511),
        (-0.02965, -0.0299, -0.04511),
    ),
}
"""Front-left, front-right, rear-left, rear-right sensor of each foot."""

LEFT_SOLE_OUTLINE_M: tuple[tuple[float, float], ...] = (
    (0.1, 0.035),
    (0.085, 0.05),
    (-0.032, 0.05),
    (-0.047, 0.035),
    (-0.047, -0.023),
    (-0.032, -0.038),
    (0.085, -0.038),
    (0.1, -0.023),
)
"""Contact outline of the left sole about the ankle axis; the right one has y mirrored."""
