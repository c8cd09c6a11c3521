"""The simulated NAO's looks: primitives on its links, sized from the published lengths.

One list serves the physics (collision shapes of the URDF) and the pictures (ray caster). The outer
size fits `nao_kinematics.yaml`, overall_dimensions; no mesh was used.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from hal.nao.joints import Vector3
from sim_backend.poses import Matrix, rot_x, rot_y, transform

ShapeKind = Literal["box", "cylinder", "sphere", "capsule"]
Axis = Literal["x", "y", "z"]
Colour3 = tuple[int, int, int]

WHITE: Colour3 = (232, 233, 235)
GREY: Colour3 = (120, 122, 128)
DARK: Colour3 = (52, 54, 60)
BLUE: Colour3 = (38, 92, 178)


@dataclass(frozen=True, slots=True)
class Shape:
    """A primitive on a link.

    `size`: half lengths of a box; radius, half length (between the caps' centres for a capsule)
    and 0 for a cylinder, whose axis is the link's `axis`; radius, 0, 0 for a sphere.
    """

    link: str
    kind: ShapeKind
    centre_m: Vector3
    size: Vector3
    colour: Colour3
    axis: Axis = "z"

    @property
    def T_link_shape(self) -> Matrix:
        """(4, 4); the primitive's own axis is z."""
        turn = {"x": rot_y(np.pi / 2), "y": rot_x(-np.pi / 2), "z": np.eye(3)}[self.axis]
        return transform(turn, self.centre_m)


_TRUNK: tuple[Shape, ...] = (
    Shape("torso", "capsule", (-0.002, 0.0, 0.088), (0.053, 0.036, 0.0), WHITE, "y"),
    Shape("torso", "capsule", (-0.004, 0.0, 0.035), (0.056, 0.030, 0.0), WHITE),
    Shape("torso", "sphere", (-0.004, 0.0, -0.045), (0.056, 0.0, 0.0), GREY),
    Shape("torso", "cylinder", (0.048, 0.0, 0.055), (0.013, 0.010, 0.0), BLUE, "x"),
    Shape("torso", "box", (-0.045, 0.0, 0.06), (0.022, 0.045, 0.055), GREY),
    Shape("Neck", "cylinder", (0.0, 0.0, -0.02), (0.026, 0.022, 0.0), DARK),
    Shape("Head", "capsule", (-0.004, 0.0, 0.055), (0.058, 0.010, 0.0), WHITE, "y"),
    Shape("Head", "sphere", (-0.010, 0.0, 0.070), (0.056, 0.0, 0.0), WHITE),
    Shape("Head", "cylinder", (0.0, 0.065, 0.056), (0.033, 0.008, 0.0), BLUE, "y"),
    Shape("Head", "cylinder", (0.0, -0.065, 0.056), (0.033, 0.008, 0.0), BLUE, "y"),
    Shape("Head", "cylinder", (0.0, 0.070, 0.056), (0.020, 0.008, 0.0), WHITE, "y"),
    Shape("Head", "cylinder", (0.0, -0.070, 0.056), (0.020, 0.008, 0.0), WHITE, "y"),
    Shape("Head", "sphere", (0.042, 0.026, 0.050), (0.0145, 0.0, 0.0), DARK),
    Shape("Head", "sphere", (0.042, -0.026, 0.050), (0.0145, 0.0, 0.0), DARK),
    Shape("Head", "sphere", (0.048, 0.0, 0.0636), (0.0100, 0.0, 0.0), DARK),
    Shape("Head", "sphere", (0.046, 0.0, 0.020), (0.0100, 0.0, 0.0), DARK),
)

# left side; the right one is its mirror image
_SIDE: tuple[Shape, ...] = (
    Shape("LShoulder", "sphere", (0.0, 0.0, 0.0), (0.036, 0.0, 0.0), WHITE),
    Shape("LBicep", "capsule", (0.055, 0.008, 0.0), (0.030, 0.030, 0.0), WHITE, "x"),
    Shape("LBicep", "cylinder", (0.040, 0.008, 0.0), (0.0315, 0.007, 0.0), BLUE, "x"),
    Shape("LElbow", "sphere", (0.0, 0.0, 0.0), (0.029, 0.0, 0.0), GREY),
    Shape("LForeArm", "capsule", (0.034, 0.0, 0.0), (0.027, 0.018, 0.0), WHITE, "x"),
    Shape("l_wrist", "cylinder", (0.018, 0.0, 0.0), (0.025, 0.016, 0.0), WHITE, "x"),
    Shape("l_wrist", "sphere", (0.052, 0.0, -0.006), (0.025, 0.0, 0.0), GREY),
    Shape("l_gripper", "capsule", (0.018, 0.014, 0.004), (0.009, 0.014, 0.0), GREY, "x"),
    Shape("l_gripper", "capsule", (0.020, -0.006, 0.006), (0.009, 0.016, 0.0), GREY, "x"),
    Shape("LPelvis", "sphere", (0.0, -0.004, 0.008), (0.040, 0.0, 0.0), GREY),
    Shape("LHip", "sphere", (0.0, 0.0, 0.0), (0.042, 0.0, 0.0), WHITE),
    Shape("LThigh", "capsule", (0.004, 0.002, -0.052), (0.041, 0.034, 0.0), WHITE),
    Shape("LThigh", "box", (0.030, 0.002, -0.055), (0.016, 0.016, 0.026), BLUE),
    Shape("LTibia", "sphere", (0.002, 0.0, 0.0), (0.037, 0.0, 0.0), GREY),
    Shape("LTibia", "capsule", (0.004, 0.002, -0.052), (0.037, 0.032, 0.0), WHITE),
    Shape("LAnklePitch", "sphere", (0.0, 0.0, 0.0), (0.034, 0.0, 0.0), GREY),
    Shape("l_ankle", "box", (0.0265, 0.006, -0.0331), (0.0735, 0.044, 0.012), WHITE),
    Shape("l_ankle", "capsule", (0.030, 0.004, -0.022), (0.020, 0.036, 0.0), WHITE, "x"),
    Shape("l_ankle", "box", (0.082, 0.006, -0.0285), (0.0225, 0.030, 0.010), BLUE),
)


def _right_name(link: str) -> str:
    return "r" + link[1:] if link.startswith("l_") else "R" + link[1:]


def _mirrored(shape: Shape) -> Shape:
    x, y, z = shape.centre_m
    return Shape(
        _right_name(shape.link), shape.kind, (x, -y, z), shape.size, shape.colour, shape.axis
    )


SHAPES: tuple[Shape, ...] = _TRUNK + _SIDE + tuple(_mirrored(shape) for shape in _SIDE)

ENCLOSING: frozenset[str] = frozenset({"Head", "Neck"})
"""Links the head's own cameras look out of; they are left out of their pictures."""
