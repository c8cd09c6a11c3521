"""Forward kinematics of a single chain and what follows from it at rest, without pybullet."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numpy.typing import NDArray

from hal.nao.feet import SOLE_IN_ANKLE_M
from hal.nao.joints import JOINTS, Vector3
from hal.nao.links import links
from hal.nao.postures import posture
from hal.types import NaoVersion
from sim_backend.poses import Matrix, inverse, moved, transform

STANDING = "StandInit"


def about(axis: Vector3, angle: float) -> Matrix:
    """Rotation by an angle about a unit axis (Rodrigues), (3, 3)."""
    x, y, z = axis
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + math.sin(angle) * K + (1.0 - math.cos(angle)) * (K @ K)


def links_in_torso(angles: NDArray[np.float64]) -> dict[str, Matrix]:
    """Frames of all links in the torso's, (4, 4) each, for angles (26,)."""
    frames = {"torso": np.eye(4)}
    for joint, angle in zip(JOINTS, angles, strict=True):
        # the opening of a hand is a fraction, not an angle of its wrist-side frame
        turn = 0.0 if joint.name.endswith("Hand") else float(angle)
        frames[joint.child] = frames[joint.parent] @ transform(
            about(joint.axis, turn), joint.origin_m
        )
    return frames


@cache
def standing_angles() -> tuple[float, ...]:
    """The posture it stands and walks in."""
    return tuple(float(angle) for angle in posture(STANDING))


@cache
def _standing_torso() -> bytes:
    frames = links_in_torso(np.array(standing_angles()))
    sole = moved(*SOLE_IN_ANKLE_M)
    T_torso_base = frames["l_ankle"] @ sole
    T_torso_base[:3, 3] = 0.5 * (T_torso_base + frames["r_ankle"] @ sole)[:3, 3]
    return inverse(T_torso_base).tobytes()


def standing_torso() -> Matrix:
    """T_base_torso when it stands, (4, 4); base is between the soles, on the floor."""
    return np.frombuffer(_standing_torso()).reshape(4, 4).copy()


@cache
def total_mass_kg(version: NaoVersion) -> float:
    """Mass of the whole robot."""
    return sum(link.mass_kg for link in links(version).values())


@cache
def standing_com_x_m(version: NaoVersion) -> float:
    """How far before the base its centre of mass is when it stands."""
    frames = links_in_torso(np.array(standing_angles()))
    T_base_torso = standing_torso()
    moment = 0.0
    for name, link in links(version).items():
        if name in frames:
            moment += link.mass_kg * float((T_base_torso @ frames[name] @ (*link.com_m, 1.0))[0])
    return moment / total_mass_kg(version)
