"""The simulated robot, opened by name through `hal.backends`."""

from __future__ import annotations

import math
import time

import numpy as np
from numpy.typing import NDArray

from hal.backends import OpenOptions
from hal.errors import BackendError
from hal.scenario import Scenario
from hal.simulation import SimulatedRobot, Truth
from hal.types import BodyState, CameraName, HeadAngles, PlanarMotion, RobotInfo
from sim_backend.body import Body
from sim_backend.camera import SimCamera
from sim_backend.clocks import LockStepClock, RealClock, WorldClock
from sim_backend.develop import developed, rgb_levels
from sim_backend.exposure import brightness_at
from sim_backend.eye import Eye
from sim_backend.furniture import object_frame
from sim_backend.options import SimOptions, checked
from sim_backend.poses import Matrix, transform, wrapped
from sim_backend.renderer import Shot, picture
from sim_backend.room import furnished
from sim_backend.scene import Scene, build_scene
from sim_backend.viewpoint import room_camera, room_lens
from sim_backend.walk import SimWalk
from sim_backend.world import World

ROOM_SIDE_MAX = 4096


class SimHead:
    """`hal.protocols.Head` on the world."""

    def __init__(self, world: World) -> None:
        self._world = world

    def look(self, target: HeadAngles, speed_rad_s: float) -> HeadAngles:
        """Turn towards `target`; see `hal.protocols.Head`."""
        return self._world.look(target, speed_rad_s)


class SimBodySensors:
    """`hal.protocols.BodySensors` on the world."""

    def __init__(self, world: World, clock: WorldClock) -> None:
        self._world, self._clock = world, clock

    def latest(self) -> BodyState:
        """The newest measurement."""
        return self._world.newest_measured(self._clock.now_ns())

    def at(self, stamp_ns: int) -> BodyState | None:
        """The measurement at a time, interpolated; None outside the recorded past."""
        return self._world.measured(stamp_ns, self._clock.now_ns())


class SimRobot:
    """`hal.simulation.SimulatedRobot`."""

    def __init__(self, options: OpenOptions, told: SimOptions) -> None:
        self._scenario = told.scenario
        self._scene = build_scene(furnished(told.scenario, told.folder, told.seed), True)
        self._info = RobotInfo(options.name, told.version, "sim", True)
        self._simulated = Body(told.version)
        if told.real_time:
            warm_up(self._scene)
        real_ns = time.monotonic_ns if told.real_time else None
        self._world = World(told.scenario, told.version, told.seed, real_ns)
        self._version, self._seed = told.version, told.seed
        self._eye = self._open_eye(options.camera, (options.width, options.height), options.fps)
        self._clock: WorldClock
        self._clock = RealClock(self._world) if told.real_time else LockStepClock(self._world)
        self._camera = self._camera_of(self._eye, options.fps)
        self._head = SimHead(self._world)
        self._body = SimBodySensors(self._world, self._clock)

    def _open_eye(self, camera: CameraName, size: tuple[int, int], fps: int) -> Eye:
        return Eye(
            self._world, self._scene, self._simulated, self._scenario, self._version,
            camera, size, fps, self._seed,
        )  # fmt: skip

    def _camera_of(self, eye: Eye, fps: int) -> SimCamera:
        return SimCamera(eye, self._world, self._clock, self._scenario.camera, fps, self._seed)

    def open_camera(self, camera: CameraName, size: tuple[int, int], fps: int) -> SimCamera:
        """One more camera of this head, beside the one that was asked for."""
        return self._camera_of(self._open_eye(camera, size, fps), fps)

    @property
    def info(self) -> RobotInfo:
        """Which robot this is."""
        return self._info

    @property
    def clock(self) -> WorldClock:
        """Virtual time in lock-step, else the machine's."""
        return self._clock

    @property
    def camera(self) -> SimCamera:
        """The head camera that was asked for."""
        return self._camera

    @property
    def head(self) -> SimHead:
        """The neck's two joints."""
        return self._head

    @property
    def walk(self) -> SimWalk:
        """The walk primitive."""
        return self._world.walk

    @property
    def body(self) -> SimBodySensors:
        """The body's sensors."""
        return self._body

    @property
    def scenario(self) -> Scenario:
        """The world it stands in, nothing left open."""
        return self._scenario

    def truth(self) -> Truth:
        """The present truth."""
        now_ns = self._clock.now_ns()
        state = self._world.present(now_ns)
        T_world_camera = self._eye.camera_pose(state)
        x, y, yaw = state.base
        return Truth(
            stamp_ns=now_ns,
            base=PlanarMotion(x, y, wrapped(yaw)),
            T_world_object=self._object_seen_from(T_world_camera),
            T_world_camera=T_world_camera,
        )

    def _object_seen_from(self, T_world_camera: Matrix) -> Matrix:
        thing = self._scenario.object
        T_world_object = object_frame(thing)
        if thing.kind == "rectangle":
            return T_world_object
        out = T_world_camera[:2, 3] - T_world_object[:2, 3]
        azimuth = math.atan2(out[1], out[0])
        z, y = np.array([math.cos(azimuth), math.sin(azimuth), 0.0]), np.array([0.0, 0.0, 1.0])
        return transform(np.stack([np.cross(y, z), y, z], axis=1), T_world_object[:3, 3])

    def place(self, pose: PlanarMotion) -> None:
        """Put the robot somewhere, standing still, head straight. Raises BackendError."""
        if not all(math.isfinite(value) for value in (pose.x, pose.y, pose.yaw)):
            raise BackendError(f"a pose is not finite: {pose}")
        self._world.place((pose.x, pose.y, pose.yaw), self._clock.now_ns())

    def advance(self, until_ns: int) -> None:
        """Let the world run until then (lock-step only). Raises BackendError in real time."""
        self._clock.advance(until_ns)

    def knock_over(self) -> None:
        """Push the robot so hard that it falls."""
        self._world.knock_over()

    def room_view(self, width: int, height: int) -> NDArray[np.uint8]:
        """The scene from a fixed place in the room, (height, width, 3) uint8 RGB.

        Raises BackendError for an impossible size.
        """
        if not (1 <= width <= ROOM_SIDE_MAX and 1 <= height <= ROOM_SIDE_MAX):
            raise BackendError(f"no picture of {width}x{height}")
        now_ns = self._clock.now_ns()
        _, shapes = self._eye.frames(self._world.present(now_ns))
        light, time_s = self._scenario.scene, (now_ns - self._world.start_ns) / 1e9
        shot = Shot(
            room_lens(width, height),
            room_camera(self._scenario)[None],
            shapes[None],
            brightness_at(light.light, light.light_drift, time_s),
        )
        return rgb_levels(picture(self._scene, shot, own_view=False, shadows=True))

    def close(self) -> None:
        """Stop; let go of the physics. May be called twice."""
        self._world.walk.stop()
        self._clock.close()
        self._simulated.close()


def warm_up(scene: Scene) -> None:
    """Let numba compile before the clock runs: with an empty cache that takes many seconds."""
    shapes = np.broadcast_to(np.eye(4), (1, int(scene.is_robot.sum()), 4, 4))
    shot = Shot(room_lens(32, 24), np.eye(4)[None], shapes)
    developed(picture(scene, shot, own_view=True), 0.0, np.random.default_rng(0))


def open_robot(options: OpenOptions) -> SimulatedRobot:
    """Open the simulation. Raises BackendError or ScenarioError, each with one line."""
    told = checked(options)
    return SimRobot(options, told)
