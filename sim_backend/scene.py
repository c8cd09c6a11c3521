"""What stands in the room, as primitives, and the arrays the ray caster reads them from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hal.nao.joints import Vector3
from sim_backend.colour import linear_from_srgb
from sim_backend.poses import Matrix
from sim_backend.raycast_types import (
    BLUE,
    BOX,
    CAPSULE,
    CASTS,
    COLUMNS,
    CYLINDER,
    KIND,
    RECTANGLE,
    RED,
    SPHERE,
    TEXELS_PER_M,
    TEXTURE,
    A,
    C,
    SceneArrays,
    U,
    V,
)
from sim_backend.shapes import ENCLOSING, SHAPES, Shape
from sim_backend.textures import Picture, TextureStore

KINDS = {
    "rectangle": RECTANGLE,
    "box": BOX,
    "cylinder": CYLINDER,
    "sphere": SPHERE,
    "capsule": CAPSULE,
}


@dataclass(frozen=True, slots=True, eq=False)
class Primitive:
    """A primitive in the world; sizes as in `raycast_shapes`, colour in sRGB levels.

    A texture takes the colour's place, `repeat` times across and down; `role` tells the object from
    the rest. What `casts` no shadow is what shadows fall on.
    """

    kind: str
    T_world: Matrix
    size: Vector3
    colour: tuple[int, int, int]
    texture: Picture | None = None
    repeat: tuple[float, float] = (1.0, 1.0)
    role: str = ""
    casts: bool = True


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """Fixed primitives first, then the robot's shapes. `T_fixed` (F, 4, 4).

    `is_object` and `is_robot`, `encloses` (P,) bool: the object, the robot, and the shapes its own
    cameras look out of.
    """

    arrays: SceneArrays
    T_fixed: NDArray[np.float64]
    is_object: NDArray[np.bool_]
    is_robot: NDArray[np.bool_]
    encloses: NDArray[np.bool_]


def build_scene(fixed: Sequence[Primitive], with_robot: bool) -> Scene:
    """Arrays of the fixed primitives, followed by the robot's `SHAPES` if wanted."""
    shapes = SHAPES if with_robot else ()
    store = TextureStore()
    arrays = _arrays(fixed, shapes, store)
    none, robot = np.zeros(len(fixed), dtype=bool), np.ones(len(shapes), dtype=bool)
    enclosing = np.array([shape.link in ENCLOSING for shape in shapes], dtype=bool)
    return Scene(
        arrays,
        np.stack([item.T_world for item in fixed]),
        np.concatenate([np.array([item.role == "object" for item in fixed]), ~robot]),
        np.concatenate([none, robot]),
        np.concatenate([none, enclosing]),
    )


def _arrays(
    fixed: Sequence[Primitive], shapes: Sequence[Shape], store: TextureStore
) -> SceneArrays:
    textures = [-1 if item.texture is None else store.add(item.texture) for item in fixed]
    sizes = [item.size for item in fixed] + [shape.size for shape in shapes]
    kinds = [item.kind for item in fixed] + [shape.kind for shape in shapes]
    levels = [item.colour for item in fixed] + [shape.colour for shape in shapes]
    rest = len(shapes)
    table = np.zeros((len(kinds), COLUMNS))
    table[:, KIND] = [KINDS[kind] for kind in kinds]
    table[:, A : C + 1] = sizes
    table[:, RED : BLUE + 1] = linear_from_srgb(np.array(levels, dtype=np.float64))
    table[:, TEXTURE] = textures + [-1] * rest
    table[:, U : V + 1] = [item.repeat for item in fixed] + [(1.0, 1.0)] * rest
    table[:, TEXELS_PER_M] = [_density(item, store) for item in fixed] + [0.0] * rest
    table[:, CASTS] = [float(item.casts) for item in fixed] + [1.0] * rest
    return SceneArrays(table, store.texels(), store.pyramids(), store.levels())


def _density(item: Primitive, store: TextureStore) -> float:
    """Texels per metre across the primitive."""
    if item.texture is None:
        return 0.0
    across = 2.0 * item.size[0] * (np.pi if item.kind == "cylinder" else 1.0)
    return store.width_of(store.add(item.texture)) * item.repeat[0] / across
