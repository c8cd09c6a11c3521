"""Pictures of a scene from given camera poses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hal.nao.cameras import PinholeFigures
from sim_backend.raycast import FIRST, count_hits, render
from sim_backend.raycast_types import (
    AMBIENT_SHARE,
    BRIGHT,
    LIGHT_X,
    LIGHT_Z,
    NEAR,
    SAMPLES,
    ViewArrays,
)
from sim_backend.raycast_view import list_tiles, project
from sim_backend.scene import Scene

_LIGHT_TO = np.array([-0.45, 0.35, 0.82])
LIGHT_TO = _LIGHT_TO / np.linalg.norm(_LIGHT_TO)
"""Where the light comes from: behind, left of and above a robot that looks along the world's x."""
AMBIENT = 0.55


@dataclass(frozen=True, slots=True, eq=False)
class Shot:
    """One exposure. K moments: `T_world_camera` (K, 4, 4) and `T_world_robot` (K, R, 4, 4).

    `T_world_robot` are the poses of the robot's shapes, R = 0 in a scene without one.
    """

    lens: PinholeFigures
    T_world_camera: NDArray[np.float64]
    T_world_robot: NDArray[np.float64]
    brightness: float = 1.0


def picture(
    scene: Scene, shot: Shot, *, own_view: bool, shadows: bool = False, thorough: bool = False
) -> NDArray[np.float32]:
    """The picture in linear light, (height, width, 3) float32, 1 is full.

    `own_view` leaves out what encloses the robot's cameras; `thorough` casts every sample.
    """
    view = _view(scene, shot, own_view)
    out = np.empty((shot.lens.height, shot.lens.width, 3), dtype=np.float32)
    arrays = scene.arrays
    render(
        view.rays, view.table, view.items, view.starts, arrays.texels, arrays.pyramids,
        arrays.levels, 1.0 / shot.lens.fx, SAMPLES if thorough else FIRST, shadows, shot.lens.width,
        out.reshape(-1, 3),
    )  # fmt: skip
    return out


def object_hits(scene: Scene, shot: Shot) -> NDArray[np.uint8]:
    """How many of each pixel's 16 samples meet the object, (height, width) uint8."""
    out = np.empty((shot.lens.height, shot.lens.width), dtype=np.uint8)
    view = _view(scene, shot, True)
    count_hits(
        view.rays, view.table, view.items, view.starts, scene.is_object, shot.lens.width,
        out.reshape(-1),
    )  # fmt: skip

    return out


def _view(scene: Scene, shot: Shot, own_view: bool) -> ViewArrays:
    T_world = _primitives_in_world(scene, shot)
    R_cw = np.swapaxes(shot.T_world_camera[:, None, :3, :3], 2, 3)
    T_camera = np.zeros_like(T_world)
    T_camera[:, :, :3, :3] = R_cw @ T_world[:, :, :3, :3]
    gap = T_world[:, :, :3, 3] - shot.T_world_camera[:, None, :3, 3]
    T_camera[:, :, :3, 3] = (R_cw @ gap[..., None])[..., 0]
    moments, count = T_world.shape[:2]
    lens = np.array([shot.lens.fx, shot.lens.fy, shot.lens.cx, shot.lens.cy])
    rays, bounds = np.empty((moments, count, 12)), np.empty((count, 4))
    table = scene.arrays.table.copy()
    project(T_camera, table, lens, rays, bounds)
    if own_view:
        bounds[scene.encloses] = (np.inf, -np.inf, np.inf, -np.inf)
    order = np.argsort(table[:, NEAR], kind="stable")
    items, starts = list_tiles(bounds, order, shot.lens.width, shot.lens.height)
    middle = T_world[moments // 2, :, :3, :3]
    table[:, LIGHT_X : LIGHT_Z + 1] = np.swapaxes(middle, 1, 2) @ LIGHT_TO
    table[:, BRIGHT] = max(shot.brightness, 0.0)
    table[:, AMBIENT_SHARE] = AMBIENT
    return ViewArrays(rays, table, items, starts)


def _primitives_in_world(scene: Scene, shot: Shot) -> NDArray[np.float64]:
    """(K, P, 4, 4)."""
    moments = shot.T_world_camera.shape[0]
    fixed = np.broadcast_to(scene.T_fixed, (moments, *scene.T_fixed.shape))
    if not scene.is_robot.any():
        return np.ascontiguousarray(fixed)
    return np.concatenate([fixed, shot.T_world_robot], axis=1)
