"""The robot as URDF text, from the figures of `hal.nao` and the primitives of `shapes`."""

from __future__ import annotations

import math

from hal.nao.joints import JOINTS, Joint
from hal.nao.links import Link, links
from hal.types import NaoVersion
from sim_backend.shapes import SHAPES, Shape

LINK_NAMES: tuple[str, ...] = ("torso", *(joint.child for joint in JOINTS))

_TURNS = {"x": (0.0, math.pi / 2, 0.0), "y": (-math.pi / 2, 0.0, 0.0), "z": (0.0, 0.0, 0.0)}

# fingers have no published mass; pybullet would give a link without inertia a whole kilogram
_FEATHER = Link(1e-6, (0.0, 0.0, 0.0), (1e-9, 0.0, 0.0, 1e-9, 0.0, 1e-9))


def _numbers(values: tuple[float, ...]) -> str:
    return " ".join(repr(float(value)) for value in values)


def _geometry(shape: Shape) -> str:
    if shape.kind == "box":
        full = tuple(2.0 * half for half in shape.size)
        return f'<box size="{_numbers(full)}"/>'
    if shape.kind == "sphere":
        return f'<sphere radius="{shape.size[0]!r}"/>'
    return f'<{shape.kind} radius="{shape.size[0]!r}" length="{2.0 * shape.size[1]!r}"/>'


def _shape(shape: Shape) -> str:
    origin = f'<origin xyz="{_numbers(shape.centre_m)}" rpy="{_numbers(_TURNS[shape.axis])}"/>'
    return f"\n<collision>{origin}<geometry>{_geometry(shape)}</geometry></collision>"


def _link(name: str, figures: Link) -> str:
    keys = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    inertia = " ".join(
        f'{key}="{value!r}"' for key, value in zip(keys, figures.inertia_kg_m2, strict=True)
    )
    shapes = "".join(_shape(shape) for shape in SHAPES if shape.link == name)
    return (
        f'<link name="{name}"><inertial><origin xyz="{_numbers(figures.com_m)}" rpy="0 0 0"/>'
        f'\n<mass value="{figures.mass_kg!r}"/><inertia {inertia}/></inertial>{shapes}</link>\n'
    )


def _joint(joint: Joint) -> str:
    return (
        f'<joint name="{joint.name}" type="revolute"><parent link="{joint.parent}"/>'
        f'<child link="{joint.child}"/><origin xyz="{_numbers(joint.origin_m)}" rpy="0 0 0"/>'
        f'\n<axis xyz="{_numbers(joint.axis)}"/>'
        f'<limit lower="{joint.lower_rad!r}" upper="{joint.upper_rad!r}" '
        f'velocity="{joint.speed_max_rad_s!r}" effort="{joint.effort_max_n_m!r}"/></joint>\n'
    )


def urdf_text(version: NaoVersion) -> str:
    """The whole robot; link frames are those of `hal.nao.joints`, all parallel at zero."""
    # pybullet's reader takes lines of at most a kilobyte
    known = links(version)
    bodies = "".join(_link(name, known.get(name, _FEATHER)) for name in LINK_NAMES)
    return f'<robot name="nao">{bodies}{"".join(_joint(joint) for joint in JOINTS)}</robot>'
