"""The base frame B: between the feet on the ground, x their mean direction, z up (paper 4.1)."""

from __future__ import annotations

import numpy as np

from naod.geometry.transforms import Matrix, Vector, inverse, transform
from naod.localisation.body_model import BodyFrames

# a foot that bears less than this share of the weight is in the air
SWING_SHARE = 0.15
# below this the robot is held up or lies: no foot says where the ground is
LIFTED_KG = 1.0


def is_lifted(foot_load_kg: tuple[float, float]) -> bool:
    """Whether the feet bear too little for the robot to stand on them."""
    return sum(foot_load_kg) < LIFTED_KG


def T_torso_base(frames: BodyFrames, foot_load_kg: tuple[float, float]) -> Matrix:
    """The base frame in the torso.

    The ground is the sole of the foot that stands, or both soles' mean weighted by their load.
    """
    weights = _support_weights(foot_load_kg)
    left, right = frames.T_torso_lsole, frames.T_torso_rsole
    normal = _unit(weights[0] * left[:3, 2] + weights[1] * right[:3, 2])
    ground = weights[0] * left[:3, 3] + weights[1] * right[:3, 3]
    centre = 0.5 * (left[:3, 3] + right[:3, 3])
    origin = centre - normal * float(normal @ (centre - ground))
    x = _unit(_unit(_on_plane(left[:3, 0], normal)) + _unit(_on_plane(right[:3, 0], normal)))
    return transform(np.column_stack((x, np.cross(normal, x), normal)), origin)


def T_base_camera(frames: BodyFrames, foot_load_kg: tuple[float, float]) -> Matrix:
    """The camera in the base frame: T_base_head T_head_camera of equation 7."""
    return inverse(T_torso_base(frames, foot_load_kg)) @ frames.T_torso_camera


def _support_weights(foot_load_kg: tuple[float, float]) -> tuple[float, float]:
    left, right = (max(load, 0.0) for load in foot_load_kg)
    total = left + right
    if total <= 0.0:
        return 0.5, 0.5
    share = left / total
    if share < SWING_SHARE:
        return 0.0, 1.0
    if share > 1.0 - SWING_SHARE:
        return 1.0, 0.0
    return share, 1.0 - share


def _on_plane(vector: Vector, normal: Vector) -> Vector:
    return vector - normal * float(normal @ vector)


def _unit(vector: Vector) -> Vector:
    return vector / np.linalg.norm(vector)
