"""The head camera in the world: takes the picture of any moment of the recorded past."""

from __future__ import annotations

import threading

import numpy as np
from numpy.typing import NDArray

from hal.nao.cameras import nominal_pinhole
from hal.scenario import Scenario
from hal.types import CameraName, NaoVersion
from sim_backend.body import Body, camera_in_head, shape_frames
from sim_backend.develop import developed
from sim_backend.exposure import STILL_PX, brightness_at, exposure_for, motion_px
from sim_backend.poses import Matrix
from sim_backend.raycast_types import SAMPLES
from sim_backend.renderer import Shot, picture
from sim_backend.scene import Scene
from sim_backend.snapshot import Snapshot
from sim_backend.streams import Purpose, stream
from sim_backend.world import World


class Eye:
    """Takes frames; knows nothing of when they are due. Its calls may come from any thread."""

    def __init__(
        self,
        world: World,
        scene: Scene,
        body: Body,
        scenario: Scenario,
        version: NaoVersion,
        camera: CameraName,
        size: tuple[int, int],
        fps: int,
        seed: int,
    ) -> None:
        self._world, self._scene, self._body = world, scene, body
        self._scenario = scenario
        self._lens = nominal_pinhole(version, *size)
        self._T_head_camera = camera_in_head(camera, scenario.camera.mount_error_deg)
        self._seed = seed
        self._busy = threading.Lock()
        self.camera: CameraName = camera
        self.size = size
        self.exposure_s = exposure_for(scenario.scene.light, fps)

    def camera_pose(self, state: Snapshot) -> Matrix:
        """T_world_camera of a state, (4, 4)."""
        return self.frames(state)[0]

    def frames(self, state: Snapshot) -> tuple[Matrix, NDArray[np.float64]]:
        """T_world_camera (4, 4) and the poses of the robot's shapes (R, 4, 4) of a state."""
        links = self._body.link_frames(state.T_world_torso, state.angles_rad)
        return links["Head"] @ self._T_head_camera, shape_frames(links)

    def take(self, middle_ns: int, sequence: int) -> NDArray[np.uint8] | None:
        """The frame whose exposure has its middle at a time, YUYV (height, width, 2) uint8.

        None if its exposure is not in the recorded past.
        """
        states = self._states(middle_ns)
        if states is None:
            return None
        with self._busy:
            poses = [self.frames(state) for state in states]
            time_s = (middle_ns - self._world.start_ns) / 1e9
            light = self._scenario.scene
            shot = Shot(
                self._lens,
                np.stack([pose[0] for pose in poses]),
                np.stack([pose[1] for pose in poses]),
                brightness_at(light.light, light.light_drift, time_s),
            )
            linear = picture(self._scene, shot, own_view=True)
            rng = stream(self._seed, Purpose.PIXELS, sequence)
            return developed(linear, self._scenario.camera.noise_std, rng)

    def _states(self, middle_ns: int) -> list[Snapshot] | None:
        """States spread over the exposure: one if the camera hardly moves in it, else sixteen."""
        span_ns = self.exposure_s * 1e9 if self._scenario.camera.blur else 0.0
        shares = (np.arange(SAMPLES) + 0.5) / SAMPLES - 0.5
        ends = [self._world.snapshot(middle_ns + round(span_ns * share)) for share in (-0.5, 0.5)]
        if ends[0] is None or ends[1] is None:
            return None
        first, last = (self.camera_pose(end) for end in ends if end is not None)
        if motion_px(first, last, self._lens.fx) < STILL_PX:
            shares = np.zeros(1)
        found = [self._world.snapshot(middle_ns + round(span_ns * share)) for share in shares]
        return [state for state in found if state is not None]
