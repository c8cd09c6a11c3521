"""Pictures and exact masks of a scenario's scene from any camera pose, for tests and benchmarks."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hal.backends import OpenOptions
from hal.nao.cameras import nominal_pinhole
from hal.scenario import Scenario
from hal.types import NaoVersion
from sim_backend.defaults import resolved
from sim_backend.develop import developed, rgb_levels
from sim_backend.exposure import brightness_at
from sim_backend.furniture import object_frame
from sim_backend.options import checked
from sim_backend.poses import Matrix, interpolated
from sim_backend.raycast_types import SAMPLES
from sim_backend.renderer import Shot, object_hits, picture
from sim_backend.room import furnished
from sim_backend.scene import build_scene
from sim_backend.streams import Purpose, stream

_NOBODY = np.zeros((1, 0, 4, 4))


class Studio:
    """The scene without the robot. Camera poses are T_world_camera (4, 4), optical axes."""

    def __init__(
        self,
        scenario: Scenario,
        version: NaoVersion = "v6",
        width: int = 640,
        height: int = 480,
        folder: Path | None = None,
        seed: int = 0,
    ) -> None:
        """Raises ScenarioError."""
        self.scenario = resolved(scenario)
        self.T_world_object = object_frame(self.scenario.object)
        furniture = furnished(self.scenario, folder or Path.cwd(), seed)
        self._scene = build_scene(furniture, False)
        self._alone = build_scene([item for item in furniture if item.role == "object"], False)
        self._lens = nominal_pinhole(version, width, height)
        light = self.scenario.scene
        self._brightness = brightness_at(light.light, light.light_drift, 0.0)

    def light_at(
        self, T_world_camera: Matrix, exposure_poses: NDArray[np.float64] | None = None
    ) -> NDArray[np.float32]:
        """Linear light, (height, width, 3) float32, 1 is full; all sixteen samples a pixel.

        `exposure_poses` (n, 4, 4): camera poses at equal times from the exposure's begin to its
        end, in place of the one pose.
        """
        return picture(
            self._scene, self._shot(T_world_camera, exposure_poses), own_view=True, thorough=True
        )

    def rgb_at(
        self, T_world_camera: Matrix, exposure_poses: NDArray[np.float64] | None = None
    ) -> NDArray[np.uint8]:
        """Noiseless picture, (height, width, 3) uint8 RGB."""
        return rgb_levels(self.light_at(T_world_camera, exposure_poses))

    def frame_at(
        self,
        T_world_camera: Matrix,
        exposure_poses: NDArray[np.float64] | None = None,
        noise_seed: int | None = None,
    ) -> NDArray[np.uint8]:
        """Picture as the camera gives it, YUYV (height, width, 2) uint8.

        With a `noise_seed` it carries the scenario's sensor noise.
        """
        linear = self.light_at(T_world_camera, exposure_poses)
        return self._developed(linear, noise_seed)

    def frame_before(
        self,
        backdrop: NDArray[np.float32],
        T_world_camera: Matrix,
        exposure_poses: NDArray[np.float64] | None = None,
        noise_seed: int | None = None,
    ) -> NDArray[np.uint8]:
        """As `frame_at`, the object alone before a picture: `backdrop` as `light_at` gives one."""
        shot = self._shot(T_world_camera, exposure_poses)
        if backdrop.shape != (shot.lens.height, shot.lens.width, 3):
            raise ValueError(f"expected a backdrop of the picture's size, got {backdrop.shape}")
        covered = (object_hits(self._alone, shot) / np.float32(SAMPLES))[..., None]
        linear = picture(self._alone, shot, own_view=True, thorough=True)
        linear += (1.0 - covered) * backdrop
        return self._developed(linear, noise_seed)

    def coverage_at(
        self, T_world_camera: Matrix, exposure_poses: NDArray[np.float64] | None = None
    ) -> NDArray[np.float64]:
        """Share of each pixel, and of the exposure, that shows the object, (height, width)."""
        return object_hits(self._scene, self._shot(T_world_camera, exposure_poses)) / SAMPLES

    def mask_at(
        self, T_world_camera: Matrix, exposure_poses: NDArray[np.float64] | None = None
    ) -> NDArray[np.uint8]:
        """255 where at least half of the pixel shows the object, else 0, (height, width) uint8."""
        covered = self.coverage_at(T_world_camera, exposure_poses) >= 0.5
        return np.where(covered, np.uint8(255), np.uint8(0))

    def _developed(self, linear: NDArray[np.float32], noise_seed: int | None) -> NDArray[np.uint8]:
        std = 0.0 if noise_seed is None else self.scenario.camera.noise_std
        return developed(linear, std, stream(noise_seed or 0, Purpose.PIXELS))

    def _shot(self, T_world_camera: Matrix, poses: NDArray[np.float64] | None) -> Shot:
        moments = T_world_camera[None] if poses is None else _spread(np.asarray(poses))
        nobody = np.broadcast_to(_NOBODY, (len(moments), 0, 4, 4))
        return Shot(self._lens, np.asarray(moments, dtype=np.float64), nobody, self._brightness)


def open_studio(options: OpenOptions) -> Studio:
    """The studio of `hal.backends`. Raises BackendError or ScenarioError."""
    told = checked(options)
    size = (options.width, options.height)
    return Studio(told.scenario, told.version, *size, told.folder, told.seed)


def _spread(poses: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sixteen camera poses in the middle of equal parts of an exposure, from its n poses."""
    if len(poses) == 1:
        return poses
    places = (np.arange(SAMPLES) + 0.5) / SAMPLES * (len(poses) - 1)
    lower = np.minimum(places.astype(np.int64), len(poses) - 2)
    return np.stack(
        [
            interpolated(poses[n], poses[n + 1], float(place - n))
            for n, place in zip(lower, places, strict=True)
        ]
    )
